//! A value of the document, asked for as what it should be.

use super::section::Section;
use super::{Range, Reader, nearest};
use std::cell::RefCell;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A value of the document with its path.
#[derive(Debug, Clone)]
pub struct Item<'r, 'd> {
    pub(super) reader: &'r Reader<'r>,
    /// Its dotted path: `targets.positions[3]`.
    pub path: String,
    pub(super) value: &'d Spanned<DeValue<'d>>,
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

    pub(super) fn table(&self) -> Option<&'d DeTable<'d>> {
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

/// `key = value`, or the key alone where the value is a table of many lines.
pub(super) fn assigned(path: &str, value: &str, is_table: bool) -> String {
    if is_table && !value.starts_with('{') { path.to_owned() } else { format!("{path} = {value}") }
}
