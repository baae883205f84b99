//! Typed reading of a TOML document that collects every problem instead of stopping at the first.
//!
//! A [`Section`] is a table under its dotted path. Each question about a key (`number`, `choice`, ...) returns `None` when
//! the key is absent *or* wrong; what is wrong is recorded with file, line, key, value and remedy. At the end
//! [`Section::finish`] reports the keys that nobody asked for.

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

/// A table of the document; empty if the document does not have it.
#[derive(Debug)]
pub struct Section<'r, 'd> {
    reader: &'r Reader<'r>,
    path: String,
    table: Option<&'d DeTable<'d>>,
    asked: RefCell<Vec<&'static str>>,
}

/// A value of the document with its path.
#[derive(Debug, Clone)]
pub struct Item<'r, 'd> {
    reader: &'r Reader<'r>,
    /// Its dotted path: `targets.positions[3]`.
    pub path: String,
    value: &'d Spanned<DeValue<'d>>,
}

impl<'r, 'd> Section<'r, 'd> {
    /// The root of a document.
    #[must_use]
    pub fn root(reader: &'r Reader<'r>, table: &'d DeTable<'d>) -> Self {
        Self { reader, path: String::new(), table: Some(table), asked: RefCell::default() }
    }

    /// Whether the document has this table.
    #[must_use]
    pub fn is_present(&self) -> bool {
        self.table.is_some()
    }

    /// The dotted path of a key of this table.
    #[must_use]
    pub fn path_of(&self, key: &str) -> String {
        if self.path.is_empty() { key.to_owned() } else { format!("{}.{key}", self.path) }
    }

    /// The value under a key, whatever it is.
    pub fn item(&self, key: &'static str) -> Option<Item<'r, 'd>> {
        self.asked.borrow_mut().push(key);
        let (name, value) = self.table?.iter().find(|(name, _)| name.get_ref() == key)?;
        let path = self.path_of(key);
        let line = self.reader.line_of(name.span().start);
        self.reader.lines.borrow_mut().insert(path.clone(), line);
        Some(Item { reader: self.reader, path, value })
    }

    /// A finite number in a range; a whole number will do.
    pub fn number(&self, key: &'static str, range: Range) -> Option<f64> {
        self.item(key)?.number(range)
    }

    /// A whole number in a range.
    pub fn count(&self, key: &'static str, low: u64, high: u64) -> Option<u64> {
        self.item(key)?.count(low, high)
    }

    /// A string.
    pub fn text(&self, key: &'static str) -> Option<String> {
        self.item(key)?.text()
    }

    /// One of a few words.
    pub fn choice<T: Copy>(&self, key: &'static str, words: &[(&'static str, T)]) -> Option<T> {
        self.item(key)?.choice(words)
    }

    /// A table; empty if it is absent or no table.
    pub fn section(&self, key: &'static str) -> Section<'r, 'd> {
        let table = self.item(key).and_then(|item| item.table());
        Section { reader: self.reader, path: self.path_of(key), table, asked: RefCell::default() }
    }

    /// Records that a key is needed and absent.
    pub fn missing(&self, key: &str, remedy: &str) {
        let path = self.path_of(key);
        let line = self.reader.line(&path);
        self.reader.add(line, &path, format!("{path} is missing: {remedy}"));
    }

    /// Whether the table has a key (right or wrong), which does not count as asking for it.
    #[must_use]
    pub fn has(&self, key: &str) -> bool {
        self.table.is_some_and(|table| table.iter().any(|(name, _)| name.get_ref() == key))
    }

    /// Reports the keys that nobody asked for.
    pub fn finish(self) {
        let asked = self.asked.borrow();
        let Some(table) = self.table else { return };
        for (name, value) in table.iter().filter(|(name, _)| !asked.contains(&name.get_ref().as_ref())) {
            let path = self.path_of(name.get_ref());
            let remedy = match nearest(name.get_ref(), &asked) {
                Some(near) => format!("did you mean \"{near}\"?"),
                None => format!("remove it; known here: {}", asked.join(", ")),
            };
            let line = self.reader.line_of(name.span().start);
            let shown = assigned(&path, &self.reader.text_of(value), value.get_ref().is_table());
            self.reader.add(Some(line), &path, format!("{shown}: unknown key: {remedy}"));
        }
    }
}

/// `key = value`, or the key alone where the value is a table of many lines.
fn assigned(path: &str, value: &str, is_table: bool) -> String {
    if is_table && !value.starts_with('{') { path.to_owned() } else { format!("{path} = {value}") }
}

impl<'r, 'd> Item<'r, 'd> {
    /// The line on which the value begins.
    #[must_use]
    pub fn line(&self) -> usize {
        self.reader.line_of(self.value.span().start)
    }

    /// Records that the value is wrong.
    pub fn wrong(&self, what: &str, remedy: &str) {
        let shown = assigned(&self.path, &self.reader.text_of(self.value), self.value.get_ref().is_table());
        self.reader.add(Some(self.line()), &self.path, format!("{shown} {what}: {remedy}"));
    }

    fn wrong_type(&self, wanted: &str) {
        let found = self.value.get_ref().type_str();
        let article = if found.starts_with(['a', 'i']) { "an" } else { "a" };
        self.wrong(&format!("is {article} {found}"), &format!("give {wanted}"));
    }

    /// The value as a finite number in a range.
    #[must_use]
    pub fn number(&self, range: Range) -> Option<f64> {
        let value = match self.value.get_ref() {
            DeValue::Integer(integer) => parse_integer(integer).map(|value| value as f64),
            DeValue::Float(float) => float.as_str().parse().ok(),
            _ => {
                self.wrong_type("a number");
                return None;
            }
        };
        match value.filter(|&value| range.contains(value)) {
            Some(value) => Some(value),
            None => {
                self.wrong("is out of range", &format!("give a number {range}"));
                None
            }
        }
    }

    /// The value as a whole number from `low` to `high`.
    #[must_use]
    pub fn count(&self, low: u64, high: u64) -> Option<u64> {
        let DeValue::Integer(integer) = self.value.get_ref() else {
            self.wrong_type("a whole number");
            return None;
        };
        let value = parse_integer(integer).and_then(|value| u64::try_from(value).ok());
        match value.filter(|value| (low..=high).contains(value)) {
            Some(value) => Some(value),
            None => {
                self.wrong("is out of range", &format!("give a whole number from {low} to {high}"));
                None
            }
        }
    }

    /// The value as a string.
    #[must_use]
    pub fn text(&self) -> Option<String> {
        let text = self.value.get_ref().as_str();
        if text.is_none() {
            self.wrong_type("a string in quotes");
        }
        text.map(str::to_owned)
    }

    /// The value as one of a few words.
    #[must_use]
    pub fn choice<T: Copy>(&self, words: &[(&'static str, T)]) -> Option<T> {
        let quoted: Vec<String> = words.iter().map(|(word, _)| format!("\"{word}\"")).collect();
        let list = quoted.join(" or ");
        let Some(text) = self.value.get_ref().as_str() else {
            self.wrong_type(&list);
            return None;
        };
        let found = words.iter().find(|(word, _)| *word == text).map(|&(_, value)| value);
        if found.is_none() {
            let names: Vec<&str> = words.iter().map(|(word, _)| *word).collect();
            let remedy = nearest(text, &names)
                .map_or_else(|| format!("give {list}"), |near| format!("did you mean \"{near}\"?"));
            self.wrong("is not known", &remedy);
        }
        found
    }

    /// Whether the value is a string, for keys that take a word or something else.
    #[must_use]
    pub fn is_text(&self) -> bool {
        self.value.get_ref().is_str()
    }

    /// Whether the value is a list, for keys that take a list or something else.
    #[must_use]
    pub fn is_list(&self) -> bool {
        self.value.get_ref().is_array()
    }

    /// The value as numbers in a range, so many of them.
    #[must_use]
    pub fn numbers<const N: usize>(&self, range: Range) -> Option<[f64; N]> {
        let items = self.items(&format!("a list of {N} numbers"))?;
        if items.len() != N {
            self.wrong(&format!("has {} entries", items.len()), &format!("give a list of {N} numbers"));
            return None;
        }
        // Every entry is read, so that every wrong one is reported.
        let read: Vec<Option<f64>> = items.iter().map(|item| item.number(range)).collect();
        let mut numbers = [0.0; N];
        for (number, value) in numbers.iter_mut().zip(read) {
            *number = value?;
        }
        Some(numbers)
    }

    /// The entries of a list.
    #[must_use]
    pub fn items(&self, wanted: &str) -> Option<Vec<Item<'r, 'd>>> {
        let Some(array) = self.value.get_ref().as_array() else {
            self.wrong_type(wanted);
            return None;
        };
        let item =
            |(index, value)| Item { reader: self.reader, path: format!("{}[{index}]", self.path), value };
        Some(array.iter().enumerate().map(item).collect())
    }

    /// The value as a section.
    #[must_use]
    pub fn into_section(self) -> Section<'r, 'd> {
        Section { reader: self.reader, table: self.table(), path: self.path, asked: RefCell::default() }
    }

    fn table(&self) -> Option<&'d DeTable<'d>> {
        let table = self.value.get_ref().as_table();
        if table.is_none() {
            self.wrong_type(&format!("a table: [{}]", self.path));
        }
        table
    }
}

fn parse_integer(integer: &toml::de::DeInteger<'_>) -> Option<i128> {
    i128::from_str_radix(integer.as_str(), integer.radix()).ok()
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
