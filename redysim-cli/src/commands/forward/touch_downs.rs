//! The touch-downs of a run, with the places of the frames at their instants.

use std::cell::RefCell;

use redysim_runtime::{ContactEvent, Frames};

use crate::results::TouchDown;
use crate::scenario::Ground;

/// Gathers touch-downs. The observer of the steps and the integration, which reports events, share it.
pub struct TouchDowns<'a> {
    ground: &'a Ground<'a>,
    /// The coordinates at the end of the last step: an event ends a step, and is reported after it.
    reached: RefCell<Vec<f64>>,
    list: RefCell<Vec<TouchDown>>,
}

impl<'a> TouchDowns<'a> {
    /// None yet.
    pub fn new(ground: &'a Ground<'a>) -> Self {
        TouchDowns { ground, reached: RefCell::default(), list: RefCell::default() }
    }

    /// The ground and what touches it.
    pub fn ground(&self) -> &'a Ground<'a> {
        self.ground
    }

    /// Takes the coordinates at the end of a step.
    pub fn reach(&self, q: &[f64]) {
        if !self.ground.contacts().is_empty() {
            q.clone_into(&mut self.reached.borrow_mut());
        }
    }

    /// Takes an event at the end of the last step.
    pub fn see(&self, event: ContactEvent<f64>) {
        let Some(contact) = self.ground.contacts().get(event.contact).filter(|_| event.touching) else { return };
        let mechanism = self.ground.mechanism();
        let q = self.reached.borrow();
        let frames = mechanism.frame_kinematics(&q, &vec![0.0; mechanism.tree().nv()]);
        let place = frames[contact.frame()].origin;
        self.list.borrow_mut().push(TouchDown { contact: event.contact, t: event.t, place });
    }

    /// Those so far.
    pub fn into_list(self) -> Vec<TouchDown> {
        self.list.into_inner()
    }
}
