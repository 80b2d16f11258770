//! Errors and warnings that are collected while a file is read.

use std::ops::Range;
use std::sync::Arc;

use crate::diagnostic::{Diagnostic, Diagnostics, Message, Severity, Text};
use crate::source::Source;

/// Collects the errors and warnings that are found while a file, and perhaps a text beside it, are read and checked.
#[derive(Debug)]
pub struct Findings {
    file: Arc<Source>,
    beside: Arc<Source>,
    /// The text that reports are about.
    text: Text,
    diagnostics: Vec<Diagnostic>,
    errors: usize,
}

impl Findings {
    /// An empty collection for a file.
    pub fn new(file: Arc<Source>) -> Self {
        Findings::with_beside(file, Arc::new(Source::new("", "")))
    }

    /// An empty collection for a file and a text beside it.
    pub fn with_beside(file: Arc<Source>, beside: Arc<Source>) -> Self {
        Findings { file, beside, text: Text::File, diagnostics: Vec::new(), errors: 0 }
    }

    /// Runs `look`; what it reports is about `text`.
    pub fn within<T>(&mut self, text: Text, look: impl FnOnce(&mut Self) -> T) -> T {
        let before = std::mem::replace(&mut self.text, text);
        let seen = look(self);
        self.text = before;
        seen
    }

    /// Adds an error at a range of bytes.
    pub fn error(&mut self, span: Range<usize>, message: Message) {
        self.errors += 1;
        self.push(Severity::Error, None, span, message);
    }

    /// Adds a warning at a range of bytes.
    pub fn warning(&mut self, span: Range<usize>, message: Message) {
        self.push(Severity::Warning, None, span, message);
    }

    /// Adds a warning whose rule has the name `lint` at a range of bytes.
    pub fn lint(&mut self, lint: &'static str, span: Range<usize>, message: Message) {
        self.push(Severity::Warning, Some(lint), span, message);
    }

    /// Adds a note whose rule has the name `lint` at a range of bytes.
    pub fn note(&mut self, lint: &'static str, span: Range<usize>, message: Message) {
        self.push(Severity::Note, Some(lint), span, message);
    }

    fn push(&mut self, severity: Severity, lint: Option<&'static str>, span: Range<usize>, message: Message) {
        let source = Arc::clone(self.source());
        self.diagnostics.push(Diagnostic::new(severity, lint, message, self.text, source, span));
    }

    fn source(&self) -> &Arc<Source> {
        match self.text {
            Text::File => &self.file,
            Text::Beside => &self.beside,
        }
    }

    /// The number of errors so far.
    pub fn errors(&self) -> usize {
        self.errors
    }

    /// The line on which a range starts, counted from 1.
    pub fn line(&self, span: &Range<usize>) -> usize {
        self.source().place(span).line
    }

    /// The text within a range of bytes; empty for a range outside the text.
    pub(crate) fn text(&self, span: &Range<usize>) -> &str {
        self.source().text.get(span.clone()).unwrap_or_default()
    }

    /// Everything found: about the file, in its order, then about the text beside it.
    pub fn into_sorted(mut self) -> Diagnostics {
        self.diagnostics.sort_by_key(Diagnostic::order);
        Diagnostics(self.diagnostics)
    }
}
