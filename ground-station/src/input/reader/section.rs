//! A table of the document: what is asked of it, and what nobody asked for.

use super::item::{Item, assigned};
use super::{Range, Reader, nearest};
use std::cell::RefCell;
use toml::de::DeTable;

/// A table of the document; empty if the document does not have it.
#[derive(Debug)]
pub struct Section<'r, 'd> {
    pub(super) reader: &'r Reader<'r>,
    pub(super) path: String,
    pub(super) table: Option<&'d DeTable<'d>>,
    pub(super) asked: RefCell<Vec<&'static str>>,
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
