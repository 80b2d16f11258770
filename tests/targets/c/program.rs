//! A mechanism in C, compiled for the target of the tests, whose functions are called from here.

use super::compilers;
use crate::common::tools::skip;
use redysim::function::Argument;
use redysim::generic::Model;
use redysim::{Function, Mechanism, Real};
use redysim_codegen::{CFiles, COptions, CScalar, c_files};
use redysim_model::{PublicInterface, Tree};
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
#[cfg(target_os = "linux")]
use std::process::Command;
use std::process::{Output, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};

/// What C code must be free of.
const WARNINGS: [&str; 8] =
    ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Wconversion", "-Wdouble-promotion", "-Wshadow", "-Werror"];

/// A mechanism in C in a folder of its own.
pub struct InC {
    folder: PathBuf,
    prefix: String,
    model: Model,
    functions: Vec<Function>,
    scalar: CScalar,
    parameters: Vec<f64>,
}

fn path(file: &Path) -> &str {
    file.to_str().expect("a path in UTF-8")
}

fn succeeded(command: &str, output: &Output) {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    assert!(output.status.success(), "{command}: {}{}", text(&output.stdout), text(&output.stderr));
}

impl InC {
    /// The mechanism of `models/<model>.toml` with options, as `redysim!` takes them.
    pub fn new(model: &str, options: &str, scalar: CScalar) -> InC {
        let file = format!("{}/models/{model}.toml", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(&file).expect("the model");
        InC::of_text(&text, model, options, scalar)
    }

    /// The mechanism of the text of a model file, which is `model`.
    pub fn of_text(text: &str, model: &str, options: &str, scalar: CScalar) -> InC {
        let loaded = Model::from_toml_with(text, model, options).unwrap_or_else(|faults| panic!("{faults}"));
        let form = COptions { scalar, ..COptions::default() };
        let CFiles { prefix, header, source, check } = c_files(&loaded.model, &form, &loaded.options).expect("C code");
        // A folder for each, since tests run side by side.
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        let name = format!("c-{}-{}", model.replace('/', "-"), COUNT.fetch_add(1, Ordering::Relaxed));
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        std::fs::create_dir_all(&folder).expect("a folder");
        for (name, text) in [
            (format!("{prefix}.h"), header.clone()),
            (format!("{prefix}.c"), source),
            (format!("{prefix}_check.c"), check),
        ] {
            std::fs::write(folder.join(name), text).expect("a file");
        }
        let declared = |function: &&Function| header.contains(&format!("void {prefix}_{}(", function.name()));
        let functions = Function::ALL.iter().filter(declared).copied().collect();
        let parameters = PublicInterface::new(&loaded.model, &loaded.options).parameters;
        let parameters = parameters.iter().map(|parameter| parameter.value).collect();
        InC { folder, prefix, model: loaded.model, functions, scalar, parameters }
    }

    /// The functions that it has.
    pub fn functions(&self) -> &[Function] {
        &self.functions
    }

    /// The source.
    pub fn source(&self) -> String {
        std::fs::read_to_string(self.folder.join(format!("{}.c", self.prefix))).expect("the source")
    }

    /// Replaces the source.
    pub fn set_source(&self, text: &str) {
        std::fs::write(self.folder.join(format!("{}.c", self.prefix)), text).expect("a file");
    }

    /// Compiles the source with `compiler` and `flags`, without warnings.
    fn compile(&self, compiler: &str, flags: &[&str], sources: &[String], program: &str) -> PathBuf {
        let program = self.folder.join(program);
        let sources = sources.iter().map(|source| self.folder.join(source));
        let mut command = compilers::command(compiler);
        let output = command.args(WARNINGS).args(flags).args(sources).arg("-o").arg(&program).arg("-lm").output();
        succeeded(&format!("{compiler} {flags:?} {}", path(&program)), &output.expect("the compiler runs"));
        program
    }

    /// Reads the header as C++, where the compiler knows it.
    pub fn read_by_cpp(&self, compiler: &str) {
        let cpp = |source: &Path| {
            let flags = ["-x", "c++", "-std=c++11", "-pedantic", "-Wall", "-Wextra", "-Werror", "-fsyntax-only"];
            compilers::command(compiler).args(flags).arg(source).output().expect("the compiler runs")
        };
        let empty = self.folder.join("empty.cpp");
        std::fs::write(&empty, "").expect("a file");
        if !cpp(&empty).status.success() {
            skip(&format!("{compiler} has no C++"));
            return;
        }
        let user = self.folder.join("user.cpp");
        std::fs::write(&user, format!("#include \"{}.h\"\n", self.prefix)).expect("a file");
        succeeded(&format!("{compiler} -x c++"), &cpp(&user));
    }

    /// Compiles the program that checks the code, and runs it: it finds no fault.
    pub fn check(&self, compiler: &str, flags: &[&str]) {
        succeeded(&format!("{} by {compiler} {flags:?}", self.prefix), &self.run_check(compiler, flags));
    }

    /// Compiles the program that checks the code, and runs it.
    pub fn run_check(&self, compiler: &str, flags: &[&str]) -> Output {
        let sources = [format!("{}.c", self.prefix), format!("{}_check.c", self.prefix)];
        let program = self.compile(compiler, flags, &sources, "check");
        compilers::program(&program).output().expect("the check runs")
    }

    /// What a compiler reports of the source, without linking it.
    pub fn compile_source(&self, compiler: &str) -> Output {
        let object = self.folder.join("source.o");
        let source = self.folder.join(format!("{}.c", self.prefix));
        let mut command = compilers::command(compiler);
        command.args(WARNINGS).arg("-c").arg(source).arg("-o").arg(object).output().expect("the compiler runs")
    }

    /// The symbols of the compiled source with their kinds, as `nm` shows them, but those that mark code and data for
    /// disassemblers of ARM (`$x`, `$d.5`), which an `nm` for another processor shows too.
    #[cfg(target_os = "linux")]
    pub fn symbols(&self, compiler: &str, flags: &[&str]) -> Vec<(String, String)> {
        let object = self.folder.join("object.o");
        // In code for any address, pointers to constants are written when it is loaded.
        let flags = [&WARNINGS[..], flags, &["-fno-pie", "-c"]].concat();
        let mut command = compilers::command(compiler);
        command.args(&flags).arg(self.folder.join(format!("{}.c", self.prefix))).arg("-o").arg(&object);
        succeeded(&format!("{compiler} {flags:?}"), &command.output().expect("the compiler runs"));
        let output = Command::new("nm").arg("--portability").arg(&object).output().expect("nm runs");
        succeeded("nm", &output);
        let symbol = |line: &str| {
            let mut words = line.split_whitespace().map(str::to_string);
            words.next().zip(words.next()).expect("a name and a kind")
        };
        let text = String::from_utf8(output.stdout).expect("text");
        text.lines().filter(|line| !line.starts_with('$')).map(symbol).collect()
    }

    /// What every function, and joint trigonometry if the robot has angles, gives in each of the states, one after the other.
    pub fn results<T: Real>(&self, compiler: &str, flags: &[&str], states: &[State<T>]) -> Vec<T> {
        std::fs::write(self.folder.join("driver.c"), self.driver()).expect("a file");
        let sources = [format!("{}.c", self.prefix), "driver.c".into()];
        let program = self.compile(compiler, flags, &sources, "driver");
        let mut input: Vec<u8> = Vec::new();
        for number in states.iter().flatten().flatten() {
            input.extend(self.bytes(number.to_f64()));
        }
        let mut command = compilers::program(&program);
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("the driver runs");
        let mut stdin = child.stdin.take().expect("its input");
        // From another thread, since the driver writes while it reads.
        let writer = std::thread::spawn(move || stdin.write_all(&input));
        let output = child.wait_with_output().expect("its output");
        writer.join().expect("no panic").expect("all is read");
        succeeded(path(&program), &output);
        self.numbers(&output.stdout)
    }

    /// What `try_init` returns for each list of parameters.
    pub fn statuses(&self, compiler: &str, lists: &[Vec<f64>]) -> Vec<usize> {
        let (prefix, number, count) = (&self.prefix, self.scalar.type_name(), self.parameters.len());
        let literal = |list: &Vec<f64>| {
            let written = |&literal: &f64| match self.scalar {
                _ if !literal.is_finite() => format!("({number})NAN"),
                CScalar::F64 => format!("{literal:?}"),
                CScalar::F32 => format!("{:?}f", literal as f32),
            };
            format!("{{{}}}", list.iter().map(written).collect::<Vec<_>>().join(", "))
        };
        let table = lists.iter().map(literal).collect::<Vec<_>>().join(", ");
        let driver = format!(
            "#include \"{prefix}.h\"\n#include <math.h>\n#include <stdio.h>\nint main(void)\n{{\n    static const {number} \
             lists[{length}][{count}] = {{{table}}};\n    {prefix}_t robot;\n    for (int i = 0; i < {length}; i++) {{\n        \
             printf(\"%d\\n\", {prefix}_try_init(&robot, lists[i]));\n    }}\n    return 0;\n}}\n",
            length = lists.len(),
        );
        std::fs::write(self.folder.join("statuses.c"), driver).expect("a file");
        let program = self.compile(compiler, &["-O1"], &[format!("{prefix}.c"), "statuses.c".into()], "statuses");
        let output = compilers::program(&program).output().expect("the program runs");
        succeeded(path(&program), &output);
        let lines = String::from_utf8(output.stdout).expect("numbers");
        lines.lines().map(|line| line.parse().expect("a number")).collect()
    }

    fn bytes(&self, number: f64) -> Vec<u8> {
        match self.scalar {
            CScalar::F64 => number.to_ne_bytes().to_vec(),
            CScalar::F32 => (number as f32).to_ne_bytes().to_vec(),
        }
    }

    fn numbers<T: Real>(&self, bytes: &[u8]) -> Vec<T> {
        match self.scalar {
            CScalar::F64 => bytes.as_chunks().0.iter().map(|&bytes| T::from_f64(f64::from_ne_bytes(bytes))).collect(),
            CScalar::F32 => {
                bytes.as_chunks().0.iter().map(|&bytes| T::from_f64(f32::from_ne_bytes(bytes).into())).collect()
            }
        }
    }

    /// A program that reads states and writes the results of all functions, as bytes.
    fn driver(&self) -> String {
        let (tree, prefix, number) = (Tree::new(&self.model), &self.prefix, self.scalar.type_name());
        let mut text = format!("#include \"{prefix}.h\"\n#include <stdio.h>\nint main(void)\n{{\n");
        let mut reads = Vec::new();
        for argument in Argument::ALL {
            let length = tree.argument_length(argument);
            let _ = writeln!(text, "    {number} {}[{}];", argument.name(), length.max(1));
            let name = argument.name();
            reads.push(format!("fread({name}, sizeof {name}[0], {length}, stdin) == {length}"));
        }
        let robot = if self.parameters.is_empty() {
            ""
        } else {
            let _ = writeln!(text, "    {prefix}_t robot;\n    {prefix}_default(&robot);");
            "&robot, "
        };
        let _ = writeln!(text, "    while ({}) {{", reads.join(" && "));
        if self.has_trig() {
            let _ = writeln!(
                text,
                "        {{\n            {prefix}_joint_trig_t trig;\n            {prefix}_joint_trig({robot}q, &trig);\n            \
                 fwrite(&trig.sines, sizeof trig.sines, 1, stdout);\n            fwrite(&trig.cosines, sizeof trig.cosines, 1, \
                 stdout);\n        }}"
            );
        }
        for function in &self.functions {
            let count = outputs(*function, &tree);
            let arguments = function.signature().arguments.iter().map(|argument| match argument {
                Argument::Wrenches => "(void *)wrenches, ".to_string(),
                other => format!("{}, ", other.name()),
            });
            let arguments: String = arguments.collect();
            let _ = writeln!(
                text,
                "        {{\n            {number} result[{count}];\n            {prefix}_{}({robot}{arguments}(void *)result);\n            \
                 fwrite(result, sizeof result, 1, stdout);\n        }}",
                function.name()
            );
        }
        text + "    }\n    return 0;\n}\n"
    }

    fn has_trig(&self) -> bool {
        std::fs::read_to_string(self.folder.join(format!("{}.h", self.prefix)))
            .expect("the header")
            .contains("_joint_trig(")
    }
}

/// The numbers of [every argument](Argument::ALL), in order.
pub type State<T> = Vec<Vec<T>>;

/// The numbers of an argument in a state.
pub fn numbers<T>(state: &State<T>, argument: Argument) -> &[T] {
    &state[Argument::ALL.iter().position(|other| *other == argument).expect("a known argument")]
}

/// How many numbers a function gives.
fn outputs(function: Function, tree: &Tree) -> usize {
    let x: Vec<Vec<f64>> =
        function.signature().arguments.iter().map(|argument| vec![0.5; tree.argument_length(*argument)]).collect();
    let x: Vec<&[f64]> = x.iter().map(Vec::as_slice).collect();
    redysim_model::denoc::evaluate(function, tree, &redysim_model::denoc::Untraced, &x).len()
}

/// Whether the mechanism in C is that of the Rust type.
pub fn is_of(in_c: &InC, mechanism: &impl Mechanism) -> bool {
    in_c.model.name == mechanism.name() && Tree::new(&in_c.model).nq() == mechanism.nq()
}
