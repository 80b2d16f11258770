//! What was found out, as tables in Markdown.

use crate::robot::{Empty, Row};

/// Time of function `index` of each row (0 is inverse dynamics, 1 forward dynamics) against that of ten joints.
pub fn print_times(function: &str, index: usize, rows: &[Row]) {
    let ten = rows.iter().find(|row| row.joints == 10);
    let per_joint = |row: &Row, time: f64| time / row.joints as f64;
    let against_ten = |value: &dyn Fn(&Row) -> f64, row: &Row| {
        ten.map_or(String::from("–"), |ten| format!("{:.2}", value(row) / value(ten)))
    };
    println!(
        "\n| {function}: joints | flops per joint | to 10 joints | ns | ns per joint | to 10 joints | in lanes | to 10 joints |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for row in rows {
        let flops = |row: &Row| per_joint(row, f64::from(row.flops[index]));
        let plain = |row: &Row| per_joint(row, row.times[index]);
        let in_lanes = |row: &Row| per_joint(row, row.in_lanes[index]);
        println!(
            "| {} | {:.0} | {} | {:.0} | {:.1} | {} | {:.2} | {} |",
            row.joints,
            flops(row),
            against_ten(&flops, row),
            row.times[index],
            plain(row),
            against_ten(&plain, row),
            in_lanes(row),
            against_ten(&in_lanes, row),
        );
    }
}

/// What it takes to compile all functions, and how much machine code they are.
pub fn print_builds(rows: &[Row], empty: &Empty) {
    println!(
        "\n| robot | generated, kB | generator, s | dev, s | release, s | machine code, kB | inverse | forward | mass matrix |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for row in rows {
        let [inverse, forward, matrix] = row.sizes.functions.map(kilobytes);
        println!(
            "| {} | {} | {:.1} | {:.1} | {:.1} | {:.0} | {inverse:.1} | {forward:.1} | {matrix:.1} |",
            row.name,
            row.source / 1000,
            row.generating,
            row.dev,
            row.release,
            kilobytes(row.sizes.text - empty.text),
        );
    }
}

/// What loops are worth.
pub fn print_loops(rows: &[Row], empty: &Empty) {
    println!("\n| | inverse, ns | forward, ns | inverse, kB | forward, kB | all functions, kB | compiling, s |");
    println!("|---|---|---|---|---|---|---|");
    for row in rows {
        let ([inverse, forward], [inverse_size, forward_size, _]) = (row.times, row.sizes.functions.map(kilobytes));
        let text = kilobytes(row.sizes.text - empty.text);
        println!(
            "| {} | {inverse:.0} | {forward:.0} | {inverse_size:.1} | {forward_size:.1} | {text:.0} | {:.0} |",
            row.name, row.release
        );
    }
}

fn kilobytes(bytes: u64) -> f64 {
    bytes as f64 / 1000.0
}
