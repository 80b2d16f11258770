//! Frames that a scenario names.

use redysim_model::Model;
use redysim_toml::{Message, Reader, Spanned};

/// The number of the frame of `model` with the name `name`, which `user` requires, as "the law `impedance`".
pub fn frame(reader: &mut Reader<'_, '_>, model: &Model, name: &Spanned<String>, user: &str) -> Option<usize> {
    if model.frames.is_empty() {
        let title = format!("{}: {user} requires a frame, but the model does not have a `[[frame]]`", reader.item());
        let help = format!(
            "add a table `[[frame]]` to the model, with name = {:?}, the `link` that it stands on and its `origin`",
            name.get_ref()
        );
        return reader.error_at(name.span(), Message { title, label: "not in the model".into(), help });
    }
    let named: Vec<_> = model.frames.iter().enumerate().map(|(index, frame)| (frame.name.as_str(), index)).collect();
    reader.lookup(name.span(), "frame", name.get_ref(), &named)
}
