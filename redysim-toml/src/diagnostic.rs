//! Errors and warnings about a file, each shown where it stands.

use crate::source::Source;
use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet, normalize_untrusted_str};
use std::collections::BTreeMap;
use std::fmt;
use std::ops::{Deref, Range};
use std::sync::Arc;

/// How bad a finding is, the worst first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Severity {
    /// The file cannot be used.
    Error,
    /// The file can be used, but probably means something else.
    Warning,
    /// The file can be used, and may well mean what it says.
    Note,
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "note",
        })
    }
}

/// The words of a finding.
#[derive(Clone, Debug, PartialEq)]
pub struct Message {
    /// Which item breaks which rule, with the value found.
    pub title: String,
    /// The fault in a few words, beside the caret.
    pub label: String,
    /// What to do.
    pub help: String,
}

impl Message {
    /// The words of a finding.
    pub fn new(title: impl Into<String>, label: impl Into<String>, help: impl Into<String>) -> Self {
        Message { title: title.into(), label: label.into(), help: help.into() }
    }
}

/// Which of the texts that are read together a finding is about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Text {
    /// The file.
    #[default]
    File,
    /// The text that is given beside it, such as the options in a program that names a model file.
    Beside,
}

/// One finding about a file, or about the text beside it. Its `Display` is the whole picture: title, place, source line
/// with carets, help.
#[derive(Clone, Debug)]
pub struct Diagnostic {
    severity: Severity,
    /// The name of the rule that is broken, where it has one.
    lint: Option<&'static str>,
    message: Message,
    text: Text,
    source: Arc<Source>,
    /// Bytes of the source; `None` where the file could not be read.
    span: Option<Range<usize>>,
}

impl Diagnostic {
    pub(crate) fn new(
        severity: Severity,
        lint: Option<&'static str>,
        message: Message,
        text: Text,
        source: Arc<Source>,
        span: Range<usize>,
    ) -> Self {
        Diagnostic { severity, lint, message, text, source, span: Some(span) }
    }

    /// An error about a file as a whole, which could not be read.
    pub fn unreadable(name: impl Into<String>, message: Message) -> Self {
        let source = Arc::new(Source::new(name, ""));
        Diagnostic { severity: Severity::Error, lint: None, message, text: Text::File, source, span: None }
    }

    /// Whether it is an error, a warning or a note.
    pub fn severity(&self) -> Severity {
        self.severity
    }

    /// The name of the rule that is broken, as files name it to allow it; `None` if it cannot be allowed.
    pub fn lint(&self) -> Option<&'static str> {
        self.lint
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

    /// The bytes concerned, of the text that was given beside the file, such as options; `None` if the finding is about
    /// the file.
    pub fn span_beside(&self) -> Option<Range<usize>> {
        self.span.clone().filter(|_| self.text == Text::Beside)
    }

    /// Line and column of the first character concerned, counted from 1, the column in characters. `None` where the
    /// file could not be read.
    pub fn position(&self) -> Option<(usize, usize)> {
        let place = self.source.place(self.span.as_ref()?);
        Some((place.line, place.column))
    }

    /// Where it stands among others: those about the file first, in its order.
    pub(crate) fn order(&self) -> (bool, Option<usize>) {
        (self.text == Text::Beside, self.span.as_ref().map(|span| span.start))
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let level = match self.severity {
            Severity::Error => Level::ERROR,
            Severity::Warning => Level::WARNING,
            Severity::Note => Level::NOTE,
        };
        let place = self.span.as_ref().map(|span| self.source.place(span));
        let title = level.primary_title(&self.message.title);
        let group = Group::with_title(match self.lint {
            Some(lint) => title.id(lint),
            None => title,
        });
        let group = match &place {
            Some(place) => group.element(
                Snippet::source(place.text)
                    .path(&self.source.name)
                    .line_start(place.line)
                    .annotation(AnnotationKind::Primary.span(place.span.clone()).label(&self.message.label)),
            ),
            None => group.element(annotate_snippets::Origin::path(&self.source.name)),
        };
        let group = group.element(Level::HELP.message(normalize_untrusted_str(&self.message.help)));
        f.write_str(&Renderer::plain().render(&[group]))
    }
}

/// Errors, warnings and notes, in the file's order. Its `Display` shows one below the other, of more than 20 of a severity
/// the first 20 and how many more there are.
#[derive(Clone, Debug, Default)]
pub struct Diagnostics(pub Vec<Diagnostic>);

impl Diagnostics {
    /// The number of findings of a severity that are shown: a file with more is corrected in several rounds, or wrong in
    /// one place of the program that wrote it.
    pub const MOST_SHOWN: usize = 20;

    /// Those of `found` that are shown, and for each severity with more of them a line in place of the others: "and 3 more
    /// errors".
    pub fn shown<'a>(found: impl IntoIterator<Item = &'a Diagnostic>) -> (Vec<&'a Diagnostic>, Vec<String>) {
        let mut counts = BTreeMap::new();
        let is_shown = |diagnostic: &&Diagnostic| {
            let count = counts.entry(diagnostic.severity).or_insert(0_usize);
            *count += 1;
            *count <= Self::MOST_SHOWN
        };
        let shown = found.into_iter().filter(is_shown).collect();
        let more = |(severity, count): (Severity, usize)| match count.saturating_sub(Self::MOST_SHOWN) {
            0 => None,
            1 => Some(format!("and 1 more {severity}")),
            more => Some(format!("and {more} more {severity}s")),
        };
        (shown, counts.into_iter().filter_map(more).collect())
    }

    /// The errors alone.
    pub fn errors(&self) -> impl Iterator<Item = &Diagnostic> {
        self.iter().filter(|diagnostic| diagnostic.severity == Severity::Error)
    }

    /// Those that `is_kept` accepts.
    pub fn filtered(mut self, is_kept: impl Fn(&Diagnostic) -> bool) -> Self {
        self.0.retain(is_kept);
        self
    }

    /// Those that break none of the rules with the names `allowed`.
    pub fn without(self, allowed: &[&str]) -> Self {
        self.filtered(|diagnostic| diagnostic.lint.is_none_or(|lint| !allowed.contains(&lint)))
    }
}

impl Deref for Diagnostics {
    type Target = [Diagnostic];

    fn deref(&self) -> &[Diagnostic] {
        &self.0
    }
}

impl IntoIterator for Diagnostics {
    type Item = Diagnostic;
    type IntoIter = std::vec::IntoIter<Diagnostic>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}

impl<'a> IntoIterator for &'a Diagnostics {
    type Item = &'a Diagnostic;
    type IntoIter = std::slice::Iter<'a, Diagnostic>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.iter()
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (shown, more) = Diagnostics::shown(self);
        let shown: Vec<_> = shown.into_iter().map(ToString::to_string).chain(more).collect();
        f.write_str(&shown.join("\n\n"))
    }
}

impl std::error::Error for Diagnostics {}
