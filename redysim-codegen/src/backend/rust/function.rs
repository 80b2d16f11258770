//! One function of a mechanism: of coordinates, and of precomputed joint trigonometry.

use super::body::{COS, MATRIX, SIN, SINES, Schedule, body, local};
use super::parametric::Form;
use super::sines::SinesWhenRead;
use super::writes::Writes;
use super::{length, results, trig};
use crate::mechanism::{FunctionProgram, TrigProgram};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{ToTokens, format_ident, quote};
use redysim_model::{Function, PublicInterface};
use redysim_runtime::function::{Argument, Dimension, Shape};

/// The name of the argument that has the coordinates with the sines and cosines.
const TRIG: &str = "trig";

/// Writes the inherent functions of one type.
#[derive(Clone, Copy)]
pub struct Writer<'a> {
    pub interface: &'a PublicInterface,
    /// The sines and cosines of all angles.
    pub trig: &'a TrigProgram,
    pub runtime: &'a TokenStream,
}

impl Writer<'_> {
    /// The function that computes the sines and cosines of all angles.
    pub fn joint_trig(&self) -> TokenStream {
        let head = joint_trig_head(self.interface, &self.angles(), self.runtime);
        let (q, runtime) = (local("q"), self.runtime);
        let sines_and_cosines = trig::sines_and_cosines(self.trig);
        let body = with_target_features(&quote! {
            #sines_and_cosines
            #runtime::JointTrig::new(#q, &sin, &cos)
        });
        quote! {
            /// The coordinates with the sines and cosines of all angles, computed once for every function whose
            /// name ends in `_with_trig`.
            #[inline]
            pub #head {
                #body
            }
        }
    }

    /// Number of angles of the mechanism.
    fn angles(&self) -> TokenStream {
        Literal::usize_unsuffixed(self.trig.angles.len()).into_token_stream()
    }

    /// The code of a function after the sines and cosines.
    fn body(&self, FunctionProgram { function, program, .. }: &FunctionProgram, schedule: &Schedule) -> TokenStream {
        let signature = function.signature();
        let arguments: Vec<&str> = signature.arguments.iter().map(|argument| argument.name()).collect();
        let as_numbers = signature.arguments.iter().filter_map(|argument| as_numbers(*argument, self.interface));
        let body = body(program, &arguments, self.runtime, schedule, |outputs| {
            results::value(signature.result, self.interface, outputs, self.runtime)
        });
        quote!(#(#as_numbers)* #body)
    }

    /// The code of a function with that of the sines and cosines that it needs.
    pub fn whole_body(&self, program: &FunctionProgram) -> TokenStream {
        let body = self.body(program, &Schedule::default());
        if program.trig.angles.is_empty() {
            return body;
        }
        let in_order = trig::in_order_of_reading(&program.trig, &program.program);
        let (computed, sines, cosines) = trig::of_function(&in_order);
        let [sin, cos] = [SIN, COS].map(local);
        quote!(#computed let (#sin, #cos) = (#sines, #cosines); #body)
    }

    /// One function with its documentation, of coordinates and of joint trigonometry. The code after the sines and
    /// cosines is a third function, inlined into both, so that sines and cosines do not go through memory.
    pub fn function(&self, program: &FunctionProgram) -> TokenStream {
        let trig_in_order = trig::in_order_of_reading(&program.trig, &program.program);
        let writes = Writes::of(program.function.signature().result, &program.program);
        let sines = writes.as_ref().and_then(|_| SinesWhenRead::of(&trig_in_order, &program.program));
        let schedule = Schedule { writes, sines };
        let (reads, body) = (Form::of(self.interface, self.runtime).reads, self.body(program, &schedule));
        let FunctionProgram { function, ref documentation, .. } = *program;
        let (Writer { interface, runtime, .. }, angles) = (*self, self.angles());
        let (head, head_with_trig) =
            (head(function, interface, runtime), head_with_trig(function, interface, &angles, runtime));
        let lines = documentation.iter().flat_map(|paragraph| std::iter::once("").chain(paragraph.lines())).skip(1);
        let docs = lines.map(|line| if line.is_empty() { String::new() } else { format!(" {line}") });
        let docs_with_trig =
            format!(" [`{0}`](Self::{0}) with sines and cosines that are already computed.", function.name());
        let (inlined, q, argument) = (inlined(function), local("q"), local(TRIG));
        let others: Vec<Ident> = others(function).collect();
        let caller = Form::of(interface, runtime).caller;
        let written = schedule.writes.as_ref().map(|_| local(MATRIX));
        let head_inlined = head_inlined(function, interface, &angles, runtime, &schedule);
        let whole = |computed: &TokenStream, sines: &TokenStream, q: &TokenStream| {
            let matrix = written.iter();
            let call = quote!(#computed #caller #inlined(#q, #sines #(, #others)* #(, #matrix)*));
            let body = with_target_features(&call);
            match &written {
                None => body,
                Some(matrix) => quote!(#runtime::write_matrix(#[inline(always)] |#matrix| #body)),
            }
        };
        let ((computed, sines), (read, given)) = match &schedule.sines {
            None => {
                let (computed, sin, cos) = trig::of_function(&trig_in_order);
                let given = quote!(&#argument.sin, &#argument.cos);
                ((computed.unwrap_or_default(), quote!(#sin, #cos)), (TokenStream::new(), given))
            }
            Some(_) => (trig::when_read(&trig_in_order, runtime), trig::given(&trig_in_order, &argument, runtime)),
        };
        let of_coordinates = whole(&computed, &sines, &quote!(#q));
        let of_joint_trig = whole(&read, &given, &quote!(&#argument.#q));
        // Inlined, the call that writes the elements would not know that it may write them into the caller's matrix.
        let not_inlined = written.as_ref().map(|_| quote!(#[inline(never)]));
        quote! {
            #(#[doc = #docs])*
            #not_inlined
            pub #head {
                #of_coordinates
            }
            #[doc = #docs_with_trig]
            #not_inlined
            pub #head_with_trig {
                #of_joint_trig
            }
            #[inline(always)]
            #head_inlined {
                #reads
                #body
            }
        }
    }
}

/// `body`, compiled for the target features that the scalar needs.
fn with_target_features(body: &TokenStream) -> TokenStream {
    quote!(S::with_target_features(#[inline(always)] || { #body }))
}

/// The names of a function's arguments.
pub fn arguments(function: Function) -> impl Iterator<Item = Ident> {
    function.signature().arguments.iter().map(|argument| local(argument.name()))
}

/// The names of the arguments after the coordinates.
fn others(function: Function) -> impl Iterator<Item = Ident> {
    arguments(function).skip(1)
}

/// The arguments with their types.
pub fn parameters(
    function: Function,
    interface: &PublicInterface,
    runtime: &TokenStream,
) -> impl Iterator<Item = TokenStream> {
    function.signature().arguments.iter().map(move |argument: &Argument| {
        let (name, length) = (local(argument.name()), length(interface, argument.dimension()));
        let element = match argument {
            Argument::Wrenches => quote!(#runtime::Wrench<S>),
            _ => quote!(S),
        };
        quote!(#name: &[#element; #length])
    })
}

/// The statement that makes one array of the numbers of an argument whose elements are structs.
fn as_numbers(argument: Argument, interface: &PublicInterface) -> Option<TokenStream> {
    let fields = match argument {
        Argument::Wrenches => ["force", "moment"].map(local),
        _ => return None,
    };
    let name = local(argument.name());
    let numbers = (0..interface.size(argument.dimension())).flat_map(|element| {
        let element = Literal::usize_unsuffixed(element);
        let vector =
            |field: &Ident| [0, 1, 2].map(Literal::usize_unsuffixed).map(|i| quote!(#name[#element].#field[#i]));
        fields.iter().flat_map(vector).collect::<Vec<_>>()
    });
    let numbers = numbers.collect::<Vec<_>>();
    Some(quote!(let #name = [#(#numbers),*];))
}

/// The name of the function that is given the sines and cosines.
fn inlined(function: Function) -> Ident {
    format_ident!("{}_inlined", function.name())
}

/// Name, arguments and result of the function that is given the sines and cosines of all `angles` angles, or those that it
/// computes when it reads them, and the matrix if it writes one.
fn head_inlined(
    function: Function,
    interface: &PublicInterface,
    angles: &TokenStream,
    runtime: &TokenStream,
    schedule: &Schedule,
) -> TokenStream {
    let name = inlined(function);
    let [sin, cos] = [SIN, COS].map(local);
    let (q, others) =
        (parameters(function, interface, runtime).take(1), parameters(function, interface, runtime).skip(1));
    let shape = function.signature().result;
    let (lifetime, matrix, output) = match schedule.writes {
        Some(_) => {
            let matrix = local(MATRIX);
            let rows = if shape == Shape::LoopJacobian { Dimension::LoopRows } else { Dimension::Velocities };
            let [rows, columns] = [rows, Dimension::Velocities].map(|dimension| length(interface, dimension));
            let argument = quote!(, #matrix: #runtime::Unwritten<'m, S, #rows, #columns>);
            (Some(quote!('m,)), Some(argument), quote!(#runtime::Written<'m>))
        }
        None => (None, None, results::output_type(shape, interface, runtime)),
    };
    let trig = match &schedule.sines {
        None => quote!(#sin: &[S; #angles], #cos: &[S; #angles]),
        Some(SinesWhenRead { angles, .. }) => {
            let (sines, angles) = (local(SINES), Literal::usize_unsuffixed(*angles));
            quote!(#sines: &mut #runtime::Sines<'_, S, #angles>)
        }
    };
    let Form { function, receiver, .. } = Form::of(interface, runtime);
    quote!(fn #name<#lifetime #function>(
        #receiver #(#q,)* #trig #(, #others)* #matrix
    ) -> #output)
}

/// Name, argument and result of the function that computes sines and cosines.
pub fn joint_trig_head(interface: &PublicInterface, angles: &TokenStream, runtime: &TokenStream) -> TokenStream {
    let nq = length(interface, Dimension::Coordinates);
    let q = local("q");
    let Form { function, receiver, .. } = Form::of(interface, runtime);
    quote!(fn joint_trig<#function>(#receiver #q: &[S; #nq]) -> #runtime::JointTrig<S, #nq, #angles>)
}

/// Name, arguments and result of a function of the joint trigonometry of `angles` angles.
pub fn head_with_trig(
    function: Function,
    interface: &PublicInterface,
    angles: &TokenStream,
    runtime: &TokenStream,
) -> TokenStream {
    let name = format_ident!("{}_with_trig", function.name());
    let nq = length(interface, Dimension::Coordinates);
    let (trig, others) = (local(TRIG), parameters(function, interface, runtime).skip(1));
    let output = results::output_type(function.signature().result, interface, runtime);
    let Form { function, receiver, .. } = Form::of(interface, runtime);
    quote!(fn #name<#function>(
        #receiver #trig: &#runtime::JointTrig<S, #nq, #angles> #(, #others)*
    ) -> #output)
}

/// Name, arguments and result of a function.
pub fn head(function: Function, interface: &PublicInterface, runtime: &TokenStream) -> TokenStream {
    let name = format_ident!("{}", function.name());
    let parameters = parameters(function, interface, runtime);
    let output = results::output_type(function.signature().result, interface, runtime);
    let Form { function, receiver, .. } = Form::of(interface, runtime);
    quote!(fn #name<#function>(#receiver #(#parameters),*) -> #output)
}
