//! Parents: known, and leading to the ground.

use super::names::{self, BASE};
use crate::messages;
use crate::schema::{Document, PointTable};
use redysim_toml::{Diagnostics, Field, Findings, Spanned};

/// The link that the key `key` of an item names; `Some(None)` is the ground. A name that is not known is reported.
pub(super) fn carrier(
    document: &Document,
    item: &str,
    key: &str,
    name: &Field<String>,
    findings: &mut Findings,
) -> Option<Option<usize>> {
    let name = name.spanned()?;
    let found = find(document, name.get_ref());
    if found.is_none() {
        unknown(document, item, key, name, findings);
    }
    found
}

/// The link of this name: `Some(None)` is the ground, `None` no link.
fn find(document: &Document, name: &str) -> Option<Option<usize>> {
    if name == BASE {
        return Some(None);
    }
    document.links.iter().position(|link| link.name.value().is_some_and(|known| known == name)).map(Some)
}

/// Reports a link name that is not known, unless a link's own name has an error: that one may be meant.
fn unknown(document: &Document, item: &str, key: &str, name: &Spanned<String>, findings: &mut Findings) {
    if document.links_complete && names::are_usable(document) {
        let links = document.links.iter().filter_map(|link| link.name.value()).map(String::as_str);
        // A suggestion compares the name with all others: of very many unknown names only those that are shown have one.
        let is_shown = findings.errors() < Diagnostics::MOST_SHOWN;
        findings.error(name.span(), messages::unknown_link(item, key, name.get_ref(), links, is_shown));
    }
}

/// The link that rigid joints make this one a part of; `None` is the ground.
fn body(link: Option<usize>, parents: &[Option<usize>], is_rigid: impl Fn(usize) -> bool) -> Option<usize> {
    let mut at = link;
    while let Some(link) = at.filter(|&link| is_rigid(link)) {
        at = parents[link];
    }
    at
}

/// The names of the links of two ends, if these are on one body: where joints for which `is_rigid` holds connect them.
pub(super) fn on_one_body<'a>(
    ends: [(&'a PointTable, Option<usize>); 2],
    parents: &[Option<usize>],
    is_rigid: impl Fn(usize) -> bool,
) -> Option<[&'a Spanned<String>; 2]> {
    let [(a, link_a), (b, link_b)] = ends;
    let [body_a, body_b] = [link_a, link_b].map(|link| body(link, parents, &is_rigid));
    if body_a == body_b { Some([a.link.spanned()?, b.link.spanned()?]) } else { None }
}

/// Each link's parent (`None` is the ground), if all are known and every link hangs on the ground in the end.
pub(super) fn parents(document: &Document, findings: &mut Findings) -> Option<Vec<Option<usize>>> {
    let parents: Vec<_> = (0..document.links.len()).map(|link| parent(document, link, findings)).collect();
    let cycles = cycles(&parents);
    for cycle in &cycles {
        let links: Vec<_> = cycle.iter().map(|&link| &document.links[link]).collect();
        let names: Vec<_> = links.iter().filter_map(|link| link.name.value()).map(String::as_str).collect();
        let Some(parent) = links.first().and_then(|link| link.parent.spanned()) else {
            continue;
        };
        let message = match names.as_slice() {
            [_] => messages::own_parent(&links[0].item),
            names => messages::cycle(names),
        };
        findings.error(parent.span(), message);
    }
    if cycles.is_empty() { parents.into_iter().collect() } else { None }
}

fn parent(document: &Document, link: usize, findings: &mut Findings) -> Option<Option<usize>> {
    let link = &document.links[link];
    carrier(document, &link.item, "parent", &link.parent, findings)
}

/// The cycles, each with its links in the order child, parent, parent's parent, from the first in the file.
fn cycles(parents: &[Option<Option<usize>>]) -> Vec<Vec<usize>> {
    let mut cycles = Vec::new();
    // The walk on which a link was first met. A walk that meets its own trace has found a cycle.
    let mut met = vec![None; parents.len()];
    for start in 0..parents.len() {
        let mut at = Some(start);
        while let Some(link) = at.filter(|&link| met[link].is_none()) {
            met[link] = Some(start);
            at = parents[link].flatten();
        }
        if let Some(entry) = at.filter(|&link| met[link] == Some(start)) {
            let mut cycle = vec![entry];
            let mut link = parents[entry].flatten();
            while let Some(next) = link.filter(|&next| next != entry) {
                cycle.push(next);
                link = parents[next].flatten();
            }
            let first = (0..cycle.len()).min_by_key(|&i| cycle[i]).unwrap_or(0);
            cycle.rotate_left(first);
            cycles.push(cycle);
        }
    }
    cycles
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_cycle_is_found_once_and_starts_with_its_first_link() {
        let on = |link| Some(Some(link));
        assert!(cycles(&[Some(None), on(0), on(0), None, on(3)]).is_empty());
        assert_eq!(cycles(&[on(0)]), [[0]]);
        assert_eq!(cycles(&[on(3), Some(None), on(3), on(4), on(2)]), [[2, 3, 4]]);
        assert_eq!(cycles(&[on(1), on(0), on(0), on(4), on(3)]), [[0, 1], [3, 4]]);
    }
}
