//! Errors of loops with the names of the loops and joints that they are about.

use core::fmt;

use super::LoopError;
use crate::closed_loop::ClosedLoop;
use crate::{ConfigurationSpace, LoopClosure, Scalar};

/// A [`LoopError`] that names its loop and its joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NamedLoopError<'a, S> {
    /// The error.
    pub error: LoopError<S>,
    /// The loop that its row belongs to.
    pub loop_name: Option<&'a str>,
    /// The name of its velocity, which is that of its joint if the joint has one velocity.
    pub joint_name: Option<&'a str>,
}

impl<M, C> ClosedLoop<'_, M, C> {
    /// The error with the names of the loop and the joint that it is about.
    pub fn with_names<S: Scalar>(&self, error: LoopError<S>) -> NamedLoopError<'_, S>
    where
        M: ConfigurationSpace<S>,
        C: LoopClosure<S, M>,
    {
        NamedLoopError {
            loop_name: error.row().and_then(|row| self.closure.loop_name(row)),
            joint_name: error.velocity().and_then(|velocity| self.mechanism.velocity_name(velocity)),
            error,
        }
    }
}

impl<S: fmt::Debug> fmt::Display for NamedLoopError<'_, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.error.fmt(f)?;
        if let (Some(row), Some(name)) = (self.error.row(), self.loop_name) {
            write!(f, "; row {row} belongs to the loop `{name}`")?;
        }
        if let (Some(velocity), Some(name)) = (self.error.velocity(), self.joint_name) {
            write!(f, "; velocity {velocity} is that of the joint `{name}`")?;
        }
        Ok(())
    }
}

impl<S: fmt::Debug> core::error::Error for NamedLoopError<'_, S> {}
