//! The options of a declaration: `functions = [mass_matrix], locked = { joint6 = "0 deg" }`.
//!
//! They are written as TOML, as in a model file, so that one reader checks both. For each piece of that text, its span
//! in the declaration is kept.

use proc_macro2::Span;
use std::ops::Range;
use syn::ext::IdentExt;
use syn::parse::{Parse, ParseStream};
use syn::punctuated::Punctuated;
use syn::{Ident, Lit, Result, Token, braced, bracketed, token};

/// Options as TOML, with the span of each piece.
#[derive(Default)]
pub struct OptionsText {
    pub text: String,
    pieces: Vec<(Range<usize>, Span)>,
}

impl OptionsText {
    /// Where the piece of the text that begins with `range` stands in the declaration.
    pub fn span_of(&self, range: &Range<usize>) -> Option<Span> {
        let holds = |piece: &&(Range<usize>, Span)| piece.0.contains(&range.start);
        self.pieces.iter().filter(holds).min_by_key(|(piece, _)| piece.len()).map(|(_, span)| *span)
    }

    fn push(&mut self, text: &str, span: Span) {
        let start = self.text.len();
        self.text += text;
        self.pieces.push((start..self.text.len(), span));
    }

    fn add(&mut self, value: &Value) {
        match value {
            Value::Plain(text, span) => self.push(text, *span),
            Value::Array(values, span) => {
                let start = self.text.len();
                self.text.push('[');
                for value in values {
                    self.add(value);
                    self.text.push(',');
                }
                self.text.push(']');
                self.pieces.push((start..self.text.len(), *span));
            }
            Value::Table(pairs, span) => {
                let start = self.text.len();
                self.text.push('{');
                for (index, pair) in pairs.iter().enumerate() {
                    self.text.push_str(if index == 0 { "" } else { "," });
                    self.add_pair(pair);
                }
                self.text.push('}');
                self.pieces.push((start..self.text.len(), *span));
            }
        }
    }

    fn add_pair(&mut self, Pair { key: (key, span), value }: &Pair) {
        self.push(key, *span);
        self.text.push('=');
        self.add(value);
    }
}

impl Parse for OptionsText {
    fn parse(input: ParseStream) -> Result<Self> {
        let mut options = OptionsText::default();
        for pair in Punctuated::<Pair, Token![,]>::parse_terminated(input)? {
            options.add_pair(&pair);
            options.text.push('\n');
        }
        Ok(options)
    }
}

struct Pair {
    key: (String, Span),
    value: Value,
}

impl Parse for Pair {
    fn parse(input: ParseStream) -> Result<Self> {
        let key = if input.peek(Ident::peek_any) {
            let ident = Ident::parse_any(input)?;
            (quoted(&ident.unraw().to_string()), ident.span())
        } else {
            let name: syn::LitStr = input.parse().map_err(|error| unexpected(error.span()))?;
            (quoted(&name.value()), name.span())
        };
        input.parse::<Token![=]>().map_err(|_| unexpected(key.1))?;
        Ok(Pair { key, value: input.parse()? })
    }
}

fn unexpected(span: Span) -> syn::Error {
    let names: Vec<_> = redysim_model::option_names().map(|name| format!("`{name} = ..`")).collect();
    let (last, others) = names.split_last().expect("a declaration has options");
    let message = format!("after the path of the model only {} and {last} can stand", others.join(", "));
    syn::Error::new(span, message)
}

/// A TOML value. A Rust name is a string.
enum Value {
    Plain(String, Span),
    Array(Vec<Value>, Span),
    Table(Vec<Pair>, Span),
}

impl Parse for Value {
    fn parse(input: ParseStream) -> Result<Self> {
        if input.peek(token::Bracket) {
            let content;
            let bracket = bracketed!(content in input);
            let values = Punctuated::<Value, Token![,]>::parse_terminated(&content)?;
            return Ok(Value::Array(values.into_iter().collect(), bracket.span.join()));
        }
        if input.peek(token::Brace) {
            let content;
            let brace = braced!(content in input);
            let pairs = Punctuated::<Pair, Token![,]>::parse_terminated(&content)?;
            return Ok(Value::Table(pairs.into_iter().collect(), brace.span.join()));
        }
        if input.peek(Ident) {
            let name: Ident = input.parse()?;
            return Ok(Value::Plain(quoted(&name.unraw().to_string()), name.span()));
        }
        let minus: Option<Token![-]> = input.parse()?;
        let sign = if minus.is_some() { "-" } else { "" };
        let literal: Lit = input.parse()?;
        let text = match &literal {
            Lit::Int(number) => format!("{sign}{}", number.base10_digits()),
            // TOML wants digits after the point.
            Lit::Float(number) => format!("{sign}{}{}", number.base10_digits(), trailing_zero(number.base10_digits())),
            Lit::Bool(flag) if minus.is_none() => flag.value.to_string(),
            Lit::Str(text) if minus.is_none() => quoted(&text.value()),
            _ => {
                return Err(syn::Error::new(literal.span(), "expected a number, a string, a name, `[..]` or `{ .. }`"));
            }
        };
        Ok(Value::Plain(text, literal.span()))
    }
}

fn trailing_zero(digits: &str) -> &'static str {
    if digits.ends_with('.') { "0" } else { "" }
}

/// A string of TOML.
fn quoted(text: &str) -> String {
    let escaped = text.chars().map(|c| match c {
        '"' | '\\' => format!("\\{c}"),
        c if c.is_control() => format!("\\u{:04X}", u32::from(c)),
        c => c.to_string(),
    });
    format!("\"{}\"", escaped.collect::<String>())
}
