//! What is wrong with a model file, shown where it stands.

pub(crate) mod messages;
mod source;

pub(crate) use source::Source;

use crate::model::Outline;
use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet, normalize_untrusted_str};
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

/// How bad a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// There is no model.
    Error,
    /// The model can be used, but probably means something else.
    Warning,
}

/// The words of a finding; all of them are written in [`messages`].
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Message {
    /// Which item breaks which rule, with the value found.
    pub(crate) title: String,
    /// The fault in a few words, beside the caret.
    pub(crate) label: String,
    /// What to do.
    pub(crate) help: String,
}

/// One finding about a model file. Its `Display` is the whole picture: title, place, source line with carets, help.
#[derive(Clone, Debug)]
pub struct Diagnostic {
    severity: Severity,
    message: Message,
    source: Arc<Source>,
    /// Bytes of the source; `None` where the file could not be read.
    span: Option<Range<usize>>,
}

impl Diagnostic {
    pub(crate) fn new(severity: Severity, message: Message, source: Arc<Source>, span: Option<Range<usize>>) -> Self {
        Diagnostic { severity, message, source, span }
    }

    /// Whether it is an error or a warning.
    pub fn severity(&self) -> Severity {
        self.severity
    }

    /// The first line: which item breaks which rule, with the value found.
    pub fn title(&self) -> &str {
        &self.message.title
    }

    /// What to do.
    pub fn help(&self) -> &str {
        &self.message.help
    }

    /// The file's name, as it was given to the loader.
    pub fn file(&self) -> &str {
        &self.source.name
    }

    /// Line and column of the first character concerned, counted from 1, the column in characters. `None` where the
    /// file could not be read.
    pub fn position(&self) -> Option<(usize, usize)> {
        let place = self.source.place(self.span.as_ref()?);
        Some((place.line, place.column))
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let level = match self.severity {
            Severity::Error => Level::ERROR,
            Severity::Warning => Level::WARNING,
        };
        let place = self.span.as_ref().map(|span| self.source.place(span));
        let group = Group::with_title(level.primary_title(&self.message.title));
        let group = match &place {
            Some(place) => group.element(
                Snippet::source(place.text)
                    .path(&self.source.name)
                    .line_start(place.line)
                    .annotation(AnnotationKind::Primary.span(place.span.clone()).label(&self.message.label)),
            ),
            None => group.element(Origin::path(&self.source.name)),
        };
        let group = group.element(Level::HELP.message(normalize_untrusted_str(&self.message.help)));
        f.write_str(&Renderer::plain().render(&[group]))
    }
}

/// Why a file is no model: every error in it, and the warnings beside them, in the file's order.
#[derive(Clone, Debug)]
pub struct Faults {
    /// Errors (at least one) and warnings.
    pub diagnostics: Vec<Diagnostic>,
    /// What could be read nevertheless: enough for a stub that lets the code around the model compile.
    pub outline: Box<Outline>,
}

impl Faults {
    /// The errors alone.
    pub fn errors(&self) -> impl Iterator<Item = &Diagnostic> {
        self.diagnostics.iter().filter(|diagnostic| diagnostic.severity == Severity::Error)
    }
}

impl fmt::Display for Faults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, diagnostic) in self.diagnostics.iter().enumerate() {
            let gap = if i == 0 { "" } else { "\n\n" };
            write!(f, "{gap}{diagnostic}")?;
        }
        Ok(())
    }
}

impl std::error::Error for Faults {}

/// Collects what is found while one file is read and checked.
pub(crate) struct Findings {
    source: Arc<Source>,
    diagnostics: Vec<Diagnostic>,
    errors: usize,
}

impl Findings {
    pub(crate) fn new(source: Arc<Source>) -> Self {
        Findings { source, diagnostics: Vec::new(), errors: 0 }
    }

    pub(crate) fn error(&mut self, span: Range<usize>, message: Message) {
        self.errors += 1;
        self.push(Severity::Error, span, message);
    }

    pub(crate) fn warning(&mut self, span: Range<usize>, message: Message) {
        self.push(Severity::Warning, span, message);
    }

    fn push(&mut self, severity: Severity, span: Range<usize>, message: Message) {
        self.diagnostics.push(Diagnostic::new(severity, message, Arc::clone(&self.source), Some(span)));
    }

    /// Number of errors so far.
    pub(crate) fn errors(&self) -> usize {
        self.errors
    }

    /// The line on which a range starts, counted from 1.
    pub(crate) fn line(&self, span: &Range<usize>) -> usize {
        self.source.place(span).line
    }

    /// Everything found, in the file's order.
    pub(crate) fn into_sorted(mut self) -> Vec<Diagnostic> {
        self.diagnostics.sort_by_key(|diagnostic| diagnostic.span.as_ref().map(|span| span.start));
        self.diagnostics
    }
}
