//! Typed reading of a TOML document that collects every problem instead of stopping at the first.
//!
//! A [`Section`] is a table under its dotted path. Each question about a key (`number`, `choice`, ...) returns `None` when
//! the key is absent *or* wrong; what is wrong is recorded with file, line, key, value and remedy. At the end
//! [`Section::finish`] reports the keys that nobody asked for.

mod item;
mod section;

pub use item::Item;
pub use section::Section;

use super::range::Range;
use super::suggest::nearest;
use crate::problem::{Problem, abridged};
use std::cell::RefCell;
use std::collections::BTreeMap;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The document being read and what was found wrong with it.
#[derive(Debug)]
pub struct Reader<'a> {
    file: &'a str,
    source: &'a str,
    problems: RefCell<Vec<Problem>>,
    lines: RefCell<BTreeMap<String, usize>>,
}

impl<'a> Reader<'a> {
    /// A reader of `source`, which stands in `file`.
    #[must_use]
    pub fn new(file: &'a str, source: &'a str) -> Self {
        Self { file, source, problems: RefCell::default(), lines: RefCell::default() }
    }

    /// The file's name, as the user gave it.
    #[must_use]
    pub fn file(&self) -> &'a str {
        self.file
    }

    /// Parses the document; a syntax error is recorded (and is then the only problem, since nothing else can be read).
    pub fn parse(&self) -> Option<DeTable<'a>> {
        match DeTable::parse(self.source) {
            Ok(document) => Some(document.into_inner()),
            Err(error) => {
                let line = error.span().map(|span| self.line_of(span.start));
                self.add(line, "", format!("not TOML: {}: mend the syntax", abridged(error.message())));
                None
            }
        }
    }

    /// Records a problem.
    pub fn add(&self, line: Option<usize>, key: &str, message: String) {
        self.add_elsewhere(self.file, line, key, message);
    }

    /// Records a problem of another file that the document names.
    pub fn add_elsewhere(&self, file: &str, line: Option<usize>, key: &str, message: String) {
        let problem = Problem { file: file.to_owned(), line, key: key.to_owned(), message };
        self.problems.borrow_mut().push(problem);
    }

    /// The line of a key that was asked for and found, or of the closest table around it.
    #[must_use]
    pub fn line(&self, key: &str) -> Option<usize> {
        let lines = self.lines.borrow();
        let mut key = key;
        loop {
            if let Some(&line) = lines.get(key) {
                return Some(line);
            }
            key = &key[..key.rfind(['.', '['])?];
        }
    }

    /// Whether a problem of this key, or of a part of it, has been recorded.
    #[must_use]
    pub fn is_wrong(&self, key: &str) -> bool {
        self.problems.borrow().iter().any(|problem| problem.key.starts_with(key))
    }

    /// All problems so far, in the order of their lines.
    #[must_use]
    pub fn into_problems(self) -> Vec<Problem> {
        let mut problems = self.problems.into_inner();
        problems.sort_by_key(|problem| (problem.file != self.file, problem.line));
        problems
    }

    fn line_of(&self, offset: usize) -> usize {
        1 + self.source.as_bytes().iter().take(offset).filter(|&&byte| byte == b'\n').count()
    }

    fn text_of(&self, value: &Spanned<DeValue<'_>>) -> String {
        abridged(self.source.get(value.span()).unwrap_or_default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn problems_of(source: &str, read: impl Fn(&Section<'_, '_>)) -> Vec<String> {
        let reader = Reader::new("m.toml", source);
        if let Some(document) = reader.parse() {
            let root = Section::root(&reader, &document);
            read(&root);
            root.finish();
        }
        reader.into_problems().iter().map(ToString::to_string).collect()
    }

    #[test]
    fn every_problem_is_collected_with_its_line() {
        let source = "a = \"x\"\nb = nan\nc = 0\ndd = 2\n[t]\nz = 1.5\n";
        let problems = problems_of(source, |root| {
            assert_eq!(root.number("a", Range::POSITIVE), None);
            assert_eq!(root.number("b", Range::between(-1.0, 1.0)), None);
            assert_eq!(root.number("c", Range::POSITIVE), None);
            assert_eq!(root.count("d", 0, 9), None);
            let section = root.section("t");
            assert_eq!(section.count("z", 0, 9), None);
            section.finish();
        });
        assert_eq!(
            problems,
            [
                "m.toml:1: a = \"x\" is a string: give a number",
                "m.toml:2: b = nan is out of range: give a number from -1 to 1",
                "m.toml:3: c = 0 is out of range: give a number above 0",
                "m.toml:4: dd = 2: unknown key: did you mean \"d\"?",
                "m.toml:6: t.z = 1.5 is a float: give a whole number",
            ]
        );
    }

    #[test]
    fn a_syntax_error_stands_alone() {
        let problems = problems_of("a = 1\nb = = 2\n", |_| ());
        assert_eq!(problems.len(), 1);
        assert!(problems[0].starts_with("m.toml:2: not TOML: "), "{problems:?}");
    }

    #[test]
    fn lists_words_and_tables_say_what_they_want() {
        let source = "p = [1, \"x\"]\nq = [1]\nr = 3\nw = \"rigid\"\nt = 5\nlist = 4\n";
        let problems = problems_of(source, |root| {
            let numbers = |key| root.item(key).and_then(|item| item.numbers::<2>(Range::NOT_NEGATIVE));
            assert_eq!(numbers("p"), None);
            assert_eq!(numbers("q"), None);
            assert_eq!(numbers("r"), None);
            assert_eq!(root.choice("w", &[("rigid-body", 1), ("point-mass", 2)]), None);
            root.section("t").finish();
            assert!(root.item("list").and_then(|item| item.items("a list")).is_none());
        });
        assert_eq!(
            problems,
            [
                "m.toml:1: p[1] = \"x\" is a string: give a number",
                "m.toml:2: q = [1] has 1 entries: give a list of 2 numbers",
                "m.toml:3: r = 3 is an integer: give a list of 2 numbers",
                "m.toml:4: w = \"rigid\" is not known: give \"rigid-body\" or \"point-mass\"",
                "m.toml:5: t = 5 is an integer: give a table: [t]",
                "m.toml:6: list = 4 is an integer: give a list",
            ]
        );
    }

    #[test]
    fn lines_are_found_by_the_closest_key() {
        let source = "[a]\nb = [1, 2]\n";
        let reader = Reader::new("m.toml", source);
        let document = reader.parse().unwrap_or_default();
        let root = Section::root(&reader, &document);
        let _ = root.section("a").item("b");
        assert_eq!(reader.line("a.b[1]"), Some(2));
        assert_eq!(reader.line("a.c"), Some(1));
        assert_eq!(reader.line("z"), None);
    }
}
