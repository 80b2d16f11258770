//! Messages about what is asked of a mechanism.

use super::super::Message;
use super::{did_you_mean, message, nearest, quoted, shortened};
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

pub(crate) fn locked_unknown(item: &str, name: &str, joints: &[&str]) -> Message {
    let meant = did_you_mean(nearest(name, joints.iter().copied()));
    message(
        format!("{item}: `locked` names {}, but there is no such joint", quoted(name)),
        "no such joint",
        format!("{meant}The joints that move are: {}", shortened(joints)),
    )
}

pub(crate) fn locked_fixed(item: &str, name: &str) -> Message {
    message(
        format!("{item}: `locked` names {}, whose joint is fixed", quoted(name)),
        "fixed already",
        "leave it out: only joints that move can be locked",
    )
}

pub(crate) fn locked_twice(item: &str, name: &str) -> Message {
    message(
        format!("{item}: `locked` holds the joint {} a second time", quoted(name)),
        "locked before",
        "a joint has a name, and so has its link: keep one of the two",
    )
}

pub(crate) fn nothing_moves_unlocked(item: &str) -> Message {
    message(
        format!("{item}: every joint is fixed or locked, so nothing moves"),
        "locks the last joint that moves",
        "leave at least one joint unlocked",
    )
}
