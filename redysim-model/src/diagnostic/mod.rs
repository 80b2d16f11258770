//! What is wrong with a model file, shown where it stands.

pub(crate) mod messages;
mod source;

pub(crate) use source::Source;

use crate::outline::Outline;
use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet, normalize_untrusted_str};
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

/// The words of a finding. Those about model files are all written in `diagnostic::messages`.
#[derive(Clone, Debug, PartialEq)]
pub struct Message {
    /// Which item breaks which rule, with the value found.
    pub title: String,
    /// The fault in a few words, beside the caret.
    pub label: String,
    /// What to do.
    pub help: String,
}

/// Which of the texts that describe a mechanism a finding is about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Text {
    /// The model file.
    #[default]
    File,
    /// The scene that is given beside it.
    Scene,
}

/// One finding about a model file, or about the scene beside it. Its `Display` is the whole picture: title, place,
/// source line with carets, help.
#[derive(Clone, Debug)]
pub struct Diagnostic {
    severity: Severity,
    message: Message,
    text: Text,
    source: Arc<Source>,
    /// Bytes of the source; `None` where the file could not be read.
    span: Option<Range<usize>>,
}

impl Diagnostic {
    /// A finding about the file as a whole, which could not be read.
    pub(crate) fn unreadable(name: String, message: Message) -> Self {
        let source = Arc::new(Source { name, text: String::new() });
        Diagnostic { severity: Severity::Error, message, text: Text::File, source, span: None }
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

    /// The bytes concerned, of the text of the scene that was given beside the file; `None` if the finding is about the
    /// file.
    pub fn span_in_scene(&self) -> Option<Range<usize>> {
        self.span.clone().filter(|_| self.text == Text::Scene)
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
            None => group.element(annotate_snippets::Origin::path(&self.source.name)),
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
    /// Whether nothing was read: the file is not there, or may not be read.
    pub unread: bool,
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

/// Collects what is found while one file, and the scene beside it, are read and checked.
pub(crate) struct Findings {
    file: Arc<Source>,
    scene: Arc<Source>,
    /// Which of the two is being looked at.
    text: Text,
    diagnostics: Vec<Diagnostic>,
    errors: usize,
}

impl Findings {
    pub(crate) fn new(file: Arc<Source>, scene: Arc<Source>) -> Self {
        Findings { file, scene, text: Text::File, diagnostics: Vec::new(), errors: 0 }
    }

    /// What `look` finds stands in `text`.
    pub(crate) fn within<T>(&mut self, text: Text, look: impl FnOnce(&mut Self) -> T) -> T {
        let before = std::mem::replace(&mut self.text, text);
        let seen = look(self);
        self.text = before;
        seen
    }

    pub(crate) fn error(&mut self, span: Range<usize>, message: Message) {
        self.errors += 1;
        self.push(Severity::Error, span, message);
    }

    pub(crate) fn warning(&mut self, span: Range<usize>, message: Message) {
        self.push(Severity::Warning, span, message);
    }

    fn push(&mut self, severity: Severity, span: Range<usize>, message: Message) {
        let (text, source) = (self.text, Arc::clone(self.source()));
        self.diagnostics.push(Diagnostic { severity, message, text, source, span: Some(span) });
    }

    fn source(&self) -> &Arc<Source> {
        match self.text {
            Text::File => &self.file,
            Text::Scene => &self.scene,
        }
    }

    /// Number of errors so far.
    pub(crate) fn errors(&self) -> usize {
        self.errors
    }

    /// The line on which a range starts, counted from 1.
    pub(crate) fn line(&self, span: &Range<usize>) -> usize {
        self.source().place(span).line
    }

    /// Everything found: about the file, in its order, then about the scene.
    pub(crate) fn into_sorted(mut self) -> Vec<Diagnostic> {
        let place = |diagnostic: &Diagnostic| diagnostic.span.as_ref().map(|span| span.start);
        self.diagnostics.sort_by_key(|diagnostic| (diagnostic.text == Text::Scene, place(diagnostic)));
        self.diagnostics
    }
}
