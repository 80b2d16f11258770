//! scratch dump
use redysim_codegen::functions::trace_with;
use redysim_codegen::graph::Node;
use redysim_codegen::passes::Passes;
use redysim_model::{Model, Tree};
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let path = format!("{}/../models/{}.toml", env!("CARGO_MANIFEST_DIR"), args[1]);
    let text = std::fs::read_to_string(&path).unwrap();
    let model = Model::from_toml(text, &path).unwrap_or_else(|f| panic!("{f}")).model;
    let tree = Tree::new(&model);
    let f = trace_with(&tree, &Passes::default()).into_iter().find(|f| f.signature.name == args[2]).unwrap();
    let g = &f.expressions.graph;
    let uses = f.expressions.uses();
    let label = |i: usize| -> String {
        match g.node(i) {
            Node::Input { argument, index } => format!("{}{}", ["q", "v", "a"][argument as usize], index + 1),
            Node::Constant(b) => format!("{:.4}", f64::from_bits(b)),
            _ => match g.name(i) {
                Some(n) => {
                    format!("{}{}{}_{}[{i}]", if n.negative { "-" } else { "" }, n.quantity, n.body + 1, n.component)
                }
                None => format!("[{i}]"),
            },
        }
    };
    for i in 0..g.len() {
        if uses[i] == 0 {
            continue;
        }
        let e =
            |e: redysim_codegen::graph::Edge| format!("{}{}", if e.is_negative() { "-" } else { "" }, label(e.node()));
        let s = match g.node(i) {
            Node::Add(a, b) => format!("{} + {}", e(a), e(b)),
            Node::Subtract(a, b) => format!("{} - {}", e(a), e(b)),
            Node::Multiply(a, b) => format!("{} * {}", e(a), e(b)),
            Node::Divide(a, b) => format!("{} / {}", e(a), e(b)),
            Node::Sin(a) => format!("sin {}", e(a)),
            Node::Cos(a) => format!("cos {}", e(a)),
            _ => continue,
        };
        println!("{} = {s}   x{}", label(i), uses[i]);
    }
    for o in &f.expressions.outputs {
        println!("out {}{}", if o.is_negative() { "-" } else { "" }, label(o.node()));
    }
}
