//! Lints: what is valid in a model, but rarely meant; most often a slip of units.

use crate::number::{counted, rounded};
use redysim_model::spatial::Vec3;
use redysim_model::{Link, Mobility, Model};
use std::ops::RangeInclusive;

/// Beyond this, the heaviest link is suspiciously heavier than the lightest.
const MASS_RATIO: f64 = 1e5;
/// Beyond this, the longest link is suspiciously longer than the next.
const LENGTH_RATIO: f64 = 100.0;
/// Hardly a mechanism reaches further, m.
const REACH: f64 = 200.0;
/// A radius of gyration as a share of the mechanism's size.
const GYRATION: RangeInclusive<f64> = 1e-4..=2.0;
/// Gravity on Earth, m/s², from the equator to the poles with some room.
const EARTH: RangeInclusive<f64> = 9.7..=9.9;

/// A line for each lint that applies.
pub fn of(model: &Model, mobility: &Mobility) -> Vec<String> {
    let mut found = Vec::new();
    found.extend(gravity(model));
    found.extend(mass_range(model));
    found.extend(length_range(model));
    found.extend(no_inertia(model));
    let size = size(model);
    found.extend(far_reach(size));
    if size > 0.0 {
        found.extend(model.links.iter().filter_map(|link| far_com(link, size)));
        found.extend(model.links.iter().filter_map(|link| odd_inertia(link, size)));
    }
    found.extend(under_actuated(model, mobility));
    found
}

fn gravity(model: &Model) -> Option<String> {
    let size = length(model.gravity);
    if size == 0.0 {
        return Some("there is no gravity".into());
    }
    (!EARTH.contains(&size)).then(|| format!("gravity is {} m/s²: Earth's is 9.81 m/s²", rounded(size)))
}

fn mass_range(model: &Model) -> Option<String> {
    let heavy = model.links.iter().filter(|link| link.mass > 0.0);
    let lightest = heavy.clone().min_by(|a, b| a.mass.total_cmp(&b.mass))?;
    let heaviest = heavy.max_by(|a, b| a.mass.total_cmp(&b.mass))?;
    (heaviest.mass > MASS_RATIO * lightest.mass).then(|| {
        format!(
            "link `{}` has {} kg, link `{}` only {} kg: kg and g?",
            heaviest.name,
            rounded(heaviest.mass),
            lightest.name,
            rounded(lightest.mass)
        )
    })
}

fn length_range(model: &Model) -> Option<String> {
    let mut lengths: Vec<(f64, &Link)> = model.links.iter().map(|link| (own_length(link), link)).collect();
    lengths.sort_by(|a, b| b.0.total_cmp(&a.0));
    let [(longest, link), (second, other), ..] = lengths.as_slice() else { return None };
    (*second > 0.0 && *longest > LENGTH_RATIO * second).then(|| {
        format!(
            "link `{}` is placed {} m from the one that carries it, and the next, `{}`, only {} m: m and mm?",
            link.name,
            rounded(*longest),
            other.name,
            rounded(*second)
        )
    })
}

fn far_reach(size: f64) -> Option<String> {
    (size > REACH).then(|| format!("the mechanism reaches {} m: m and mm?", rounded(size)))
}

fn no_inertia(model: &Model) -> Option<String> {
    let trace: f64 = model.links.iter().map(|link| link.inertia.xx + link.inertia.yy + link.inertia.zz).sum();
    let mass: f64 = model.links.iter().map(|link| link.mass).sum();
    (mass > 0.0 && trace == 0.0).then(|| "no link has an `inertia`: all masses are points".into())
}

fn far_com(link: &Link, size: f64) -> Option<String> {
    let distance = length(link.com);
    (distance > size).then(|| {
        format!(
            "link `{}`: its centre of mass is {} m from its frame, further than the whole mechanism reaches, {} m: m \
             and mm?",
            link.name,
            rounded(distance),
            rounded(size)
        )
    })
}

/// The largest moment is at least a third of the trace: enough to tell units apart, without eigenvalues.
fn odd_inertia(link: &Link, size: f64) -> Option<String> {
    let trace = link.inertia.xx + link.inertia.yy + link.inertia.zz;
    if trace <= 0.0 || link.mass <= 0.0 {
        return None;
    }
    let gyration = (trace / (2.0 * link.mass)).sqrt();
    (!GYRATION.contains(&(gyration / size))).then(|| {
        format!(
            "link `{}`: with this `mass` and `inertia` its radius of gyration is {} m, in a mechanism of {} m: \
             kg m² and another unit?",
            link.name,
            rounded(gyration),
            rounded(size)
        )
    })
}

fn under_actuated(model: &Model, mobility: &Mobility) -> Option<String> {
    let actuated = model.moving_links().filter(|link| link.actuated).count();
    (actuated < mobility.mobility).then(|| {
        format!("the mobility is {}, but there is an actuator at {}", mobility.mobility, counted(actuated, "joint"))
    })
}

/// How far the mechanism reaches when it is stretched: the longest way from the ground over the origins of the links'
/// frames, or over the points of its cuts.
fn size(model: &Model) -> f64 {
    let reach = |link: Option<usize>| {
        let chain = std::iter::successors(link, |&link| model.links[link].parent);
        chain.map(|link| own_length(&model.links[link])).sum::<f64>()
    };
    let ends = (0..model.links.len()).map(|link| reach(Some(link)));
    let sides = model.loops.iter().flat_map(|cut| [&cut.a, &cut.b]);
    ends.chain(sides.map(|side| reach(side.link) + length(side.point))).fold(0.0, f64::max)
}

fn own_length(link: &Link) -> f64 {
    length(link.placement.position) + link.offset_along_axis().abs() + length(link.frame.position)
}

fn length(vector: Vec3<f64>) -> f64 {
    vector.dot(vector).sqrt()
}
