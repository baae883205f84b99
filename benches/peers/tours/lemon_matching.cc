// Minimum-weight perfect matching of the complete graph on the points of a file, by LEMON. Prints seconds and weight.
#include <lemon/matching.h>
#include <lemon/smart_graph.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <vector>

int main(int, char** arguments) {
    FILE* file = std::fopen(arguments[1], "r");
    if (!file) return 1;
    std::fscanf(file, "x,y");
    std::vector<double> x, y;
    for (double a, b; std::fscanf(file, " %lf,%lf", &a, &b) == 2;) x.push_back(a), y.push_back(b);
    std::fclose(file);

    const auto start = std::chrono::steady_clock::now();
    lemon::SmartGraph graph;
    lemon::SmartGraph::EdgeMap<double> weight(graph);
    for (size_t i = 0; i < x.size(); i++) graph.addNode();
    for (size_t i = 0; i < x.size(); i++)
        for (size_t j = 0; j < i; j++) {
            const auto edge = graph.addEdge(graph.nodeFromId(i), graph.nodeFromId(j));
            weight[edge] = -std::sqrt((x[i] - x[j]) * (x[i] - x[j]) + (y[i] - y[j]) * (y[i] - y[j]));
        }
    lemon::MaxWeightedPerfectMatching<lemon::SmartGraph, lemon::SmartGraph::EdgeMap<double>> matching(graph, weight);
    if (!matching.run()) return 2;
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    std::printf("%.9f %.9f\n", seconds.count(), -matching.matchingWeight());
}
