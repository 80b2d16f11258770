//! Messages about what is asked of a mechanism.

use super::super::Message;
use super::{did_you_mean, message, nearest, quoted};
use crate::scene::FUNCTIONS;

pub(crate) fn unknown_function(item: &str, name: &str) -> Message {
    let meant = did_you_mean(nearest(name, FUNCTIONS));
    message(
        format!("{item}: `functions` names {}, but there is no such function", quoted(name)),
        "no such function",
        format!("{meant}The functions are: {}", FUNCTIONS.join(", ")),
    )
}

pub(crate) fn repeated_function(item: &str, name: &str) -> Message {
    message(format!("{item}: `functions` names `{name}` twice"), "named before", "delete one of the two")
}

pub(crate) fn no_functions(item: &str) -> Message {
    message(
        format!("{item}: `functions` names no function"),
        "nothing is wanted",
        format!("without `functions` there are all of them: {}", FUNCTIONS.join(", ")),
    )
}

pub(crate) fn function_of_loops(item: &str, name: &str) -> Message {
    message(
        format!("{item}: `functions` names `{name}`, but there are no loops"),
        "the model has no [[loop]]",
        "leave it out, or add the loops; a tree has the functions that do not begin with `loop_`",
    )
}
