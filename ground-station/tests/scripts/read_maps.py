"""Opens what `export` wrote with libraries of others: KML with fastkml, GeoJSON with geojson and shapely, missions with pymavlink.

    python read_maps.py FOLDER
"""

import json
import math
import pathlib
import sys

import geojson
import shapely.geometry
from fastkml import KML, Placemark
from fastkml.utils import find_all
from pymavlink import mavwp

# It rounds to 6 places unless told otherwise: a tenth of a metre.
geojson.geometry.DEFAULT_PRECISION = 12


def metres(a, b):
    """Between two places (longitude, latitude), on a plane: a field is small."""
    east = (a[0] - b[0]) * 111_320.0 * math.cos(math.radians(a[1]))
    return math.hypot(east, (a[1] - b[1]) * 111_132.0)


def read_kml(path):
    document = KML.parse(str(path), validate=True)
    marks = list(find_all(document, of_type=Placemark))
    points = [mark for mark in marks if mark.geometry is not None and mark.geometry.geom_type == "Point"]
    lines = [mark for mark in marks if mark.geometry is not None and mark.geometry.geom_type == "LineString"]
    text = path.read_text()
    print(f"{path.name}: {len(marks)} placemarks, {len(points)} points, {len(lines)} lines, {text.count('<gx:Track>')} tracks")
    return {mark.name: (mark.geometry.x, mark.geometry.y) for mark in points}


def read_geojson(path):
    collection = geojson.loads(path.read_text())
    assert collection.is_valid, collection.errors()
    targets = {}
    for feature in collection["features"]:
        shape = shapely.geometry.shape(feature["geometry"])
        assert shape.is_valid and not shape.is_empty, feature["properties"]
        if feature["properties"]["kind"] == "target":
            targets[str(feature["properties"]["id"])] = (shape.x, shape.y)
    kinds = sorted({feature["geometry"]["type"] for feature in collection["features"]})
    print(f"{path.name}: {len(collection['features'])} features of {kinds}")
    return targets


def read_missions(folder):
    for path in sorted(folder.glob("*.waypoints")):
        loader = mavwp.MAVWPLoader()
        count = loader.load(str(path))
        commands = [loader.wp(number).command for number in range(count)]
        items = json.loads(path.with_suffix(".plan").read_text())["mission"]["items"]
        assert commands[-len(items):] == [item["command"] for item in items], (commands, items)
        print(f"{path.name}: {count} waypoints, as many as in the plan and its home")


def main(folder):
    folder = pathlib.Path(folder)
    kml, plane = read_kml(folder / "mission.kml"), read_geojson(folder / "mission.geojson")
    assert len(plane) > 0 and kml.keys() == plane.keys(), (kml, plane)
    assert all(metres(place, plane[name]) < 0.01 for name, place in kml.items()), (kml, plane)
    print(f"{len(plane)} targets at the same places in both maps")
    read_missions(folder)


main(sys.argv[1])
