//! The functions an object offers, each written in Cranelift's IR: `header` documents them.

use crate::DEFAULT_BUDGET;
use crate::block::Block;
use crate::compile::{Compiled, declare_one, define_entry, refuse};
use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{self as clif, AbiParam, InstBuilder, MemFlagsData, types};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use cranelift_module::{DataDescription, DataId, Linkage, Module as MachineModule};
use iecc_ir::{FaultCode, Module, Region};
use iecc_target::{TargetError, region_bytes};
use std::collections::BTreeMap;

/// What `header` must know of an object.
#[derive(Debug)]
pub(super) struct Interface {
    /// The memory of a controller.
    pub(super) block: Block,
    /// Stack a scan takes at most.
    pub(super) stack_bytes: u64,
}

/// Text for 0 and for numbers that are no fault.
pub(super) const NO_FAULT: [&str; 2] = ["no fault", "unknown fault"];

/// Adds the functions of the interface to the unit that holds the program.
pub(super) fn define(
    module: &Module,
    name: &str,
    mut compiled: Compiled,
    unit: &mut dyn MachineModule,
) -> Result<Interface, Vec<TargetError>> {
    define_entry(
        &mut compiled,
        unit,
        &format!("{name}_scan"),
        Linkage::Export,
    )?;
    let Compiled {
        block, stack_bytes, ..
    } = compiled;
    let mut maker = Maker {
        pointer: unit.target_config().pointer_type(),
        name,
        unit,
    };
    maker.size("state_size", block.len())?;
    maker.size("inputs_size", region_bytes(module, Region::Input).len())?;
    maker.size("outputs_size", region_bytes(module, Region::Output).len())?;
    maker.init(module, &block)?;
    maker.fault_text()?;
    maker.fault_place(module)?;
    Ok(Interface { block, stack_bytes })
}

struct Maker<'m> {
    unit: &'m mut dyn MachineModule,
    name: &'m str,
    pointer: clif::Type,
}

/// Writes the code of a function, given its parameters and the data it uses.
type Fill<'f> = dyn FnMut(&mut FunctionBuilder<'_>, &[clif::Value], &[clif::GlobalValue]) + 'f;

type Made = Result<(), Vec<TargetError>>;

impl Maker<'_> {
    /// Defines `name_…`, whose code `fill` writes.
    fn function(
        &mut self,
        name: &str,
        params: &[clif::Type],
        result: Option<clif::Type>,
        data: &[DataId],
        fill: &mut Fill<'_>,
    ) -> Made {
        let mut context = self.unit.make_context();
        let mut frontend = FunctionBuilderContext::new();
        let signature = &mut context.func.signature;
        signature.params = params.iter().copied().map(AbiParam::new).collect();
        signature.returns = result.into_iter().map(AbiParam::new).collect();
        let name = format!("{}_{name}", self.name);
        let id = declare_one(self.unit, &name, Linkage::Export, signature);
        let data: Vec<_> = data
            .iter()
            .map(|&id| self.unit.declare_data_in_func(id, &mut context.func))
            .collect();
        let config = self.unit.target_config();
        let mut builder = FunctionBuilder::new(&mut context.func, &mut frontend);
        let entry = builder.create_block();
        builder.append_block_params_for_function_params(entry);
        builder.switch_to_block(entry);
        let params = builder.block_params(entry).to_vec();
        fill(&mut builder, &params, &data);
        builder.seal_all_blocks();
        builder.finalize(config);
        let defined = self.unit.define_function(id, &mut context);
        defined.map_err(|error| refuse(&error, None))
    }

    /// Bytes that never change.
    fn data(&mut self, bytes: Vec<u8>, alignment: u64) -> DataId {
        let id = self.unit.declare_anonymous_data(false, false);
        let id = id.expect("data without a name");
        let mut description = DataDescription::new();
        description.define(bytes.into_boxed_slice());
        description.set_align(alignment);
        self.unit
            .define_data(id, &description)
            .expect("declared just now");
        id
    }

    fn size(&mut self, name: &str, bytes: usize) -> Made {
        let pointer = self.pointer;
        self.function(name, &[], Some(pointer), &[], &mut |builder, _, _| {
            let bytes = builder.ins().iconst(pointer, bytes as i64);
            builder.ins().return_(&[bytes]);
        })
    }

    /// `void init(state)`: clears the block and fills in the runs of words that are not 0.
    fn init(&mut self, module: &Module, block: &Block) -> Made {
        let words = words(&block.initial(&module.image, DEFAULT_BUDGET as i64));
        let runs = runs(&words);
        let bytes = runs.iter().flat_map(|word| word.to_ne_bytes()).collect();
        let (pointer, count) = (self.pointer, words.len());
        let data = self.data(bytes, 8);
        self.function(
            "init",
            &[pointer],
            None,
            &[data],
            &mut |builder, params, data| {
                let mut init = Init { builder, pointer };
                init.clear(params[0], count);
                init.fill(params[0], data[0], runs.len());
            },
        )
    }

    /// `const char *fault_text(int)`.
    fn fault_text(&mut self) -> Made {
        let last = FaultCode::ALL.iter().map(|fault| fault.number()).max();
        let last = last.expect("there are faults");
        let texts = (0..=last + 1).map(|number| match FaultCode::from_number(number) {
            Some(fault) => fault.meaning(),
            None if number == 0 => NO_FAULT[0],
            None => NO_FAULT[1],
        });
        let texts: Vec<&str> = texts.collect();
        let unknown = i64::from(last) + 1;
        let data = self.texts(&texts);
        let pointer = self.pointer;
        self.function(
            "fault_text",
            &[types::I32],
            Some(pointer),
            &data,
            &mut |builder, params, data| {
                let unknown = builder.ins().iconst(types::I32, unknown);
                // Read as unsigned, so that numbers below 0 are unknown too.
                let number = builder.ins().umin(params[0], unknown);
                return_text(builder, pointer, number, data);
            },
        )
    }

    /// `const char *fault_place(state)`: where the last fault arose.
    fn fault_place(&mut self, module: &Module) -> Made {
        let labels = module.origins.values().map(|origin| &*origin.label);
        let texts: Vec<&str> = std::iter::once("").chain(labels).collect();
        let last = texts.len() as i64 - 1;
        let data = self.texts(&texts);
        let pointer = self.pointer;
        self.function(
            "fault_place",
            &[pointer],
            Some(pointer),
            &data,
            &mut |builder, params, data| {
                let flags = MemFlagsData::trusted();
                let at = Block::FAULT_ORIGIN;
                let number = builder.ins().load(types::I32, flags, params[0], at);
                let last = builder.ins().iconst(types::I32, last);
                let number = builder.ins().umin(number, last);
                return_text(builder, pointer, number, data);
            },
        )
    }

    /// Two pieces of data: where each text begins, `u32`, and all texts. Equal ones are kept once.
    fn texts(&mut self, texts: &[&str]) -> [DataId; 2] {
        let (mut starts, mut all) = (Vec::new(), Vec::new());
        let mut known = BTreeMap::new();
        for &text in texts {
            let start = *known.entry(text).or_insert_with(|| {
                let start = all.len() as u32;
                // A text ends at its first zero byte.
                all.extend(text.bytes().filter(|&byte| byte != 0).chain([0]));
                start
            });
            starts.extend(start.to_ne_bytes());
        }
        [self.data(starts, 4), self.data(all, 1)]
    }
}

/// Returns the text of a number that is in the table.
fn return_text(
    builder: &mut FunctionBuilder<'_>,
    pointer: clif::Type,
    number: clif::Value,
    data: &[clif::GlobalValue],
) {
    let starts = builder.ins().symbol_value(pointer, data[0]);
    let texts = builder.ins().symbol_value(pointer, data[1]);
    let index = builder.ins().uextend(pointer, number);
    let distance = builder.ins().ishl_imm_u(index, 2);
    let at = builder.ins().iadd(starts, distance);
    let start = builder
        .ins()
        .load(types::I32, MemFlagsData::trusted(), at, 0);
    let start = builder.ins().uextend(pointer, start);
    let text = builder.ins().iadd(texts, start);
    builder.ins().return_(&[text]);
}

/// The bytes of a block as words.
fn words(bytes: &[u8]) -> Vec<u64> {
    let word = |bytes: &[u8]| u64::from_ne_bytes(bytes.try_into().expect("eight bytes"));
    bytes.chunks_exact(8).map(word).collect()
}

/// Each run of words that are not 0: where it begins and ends, in bytes, and the words.
fn runs(words: &[u64]) -> Vec<u64> {
    let (mut runs, mut at) = (Vec::new(), 0);
    for run in words.split(|&word| word == 0) {
        if !run.is_empty() {
            runs.extend([at as u64 * 8, (at + run.len()) as u64 * 8]);
            runs.extend(run);
        }
        at += run.len() + 1;
    }
    runs
}

/// Code that fills a block.
struct Init<'i, 'f> {
    builder: &'i mut FunctionBuilder<'f>,
    pointer: clif::Type,
}

impl Init<'_, '_> {
    fn clear(&mut self, block: clif::Value, words: usize) {
        let builder = &mut *self.builder;
        let (body, next) = (builder.create_block(), builder.create_block());
        let at = builder.append_block_param(body, self.pointer);
        let end = builder.ins().iadd_imm_s(block, words as i64 * 8);
        let zero = builder.ins().iconst(types::I64, 0);
        builder.ins().jump(body, &[block.into()]);
        builder.switch_to_block(body);
        builder.ins().store(MemFlagsData::trusted(), zero, at, 0);
        let after = builder.ins().iadd_imm_s(at, 8);
        let more = builder.ins().icmp(IntCC::UnsignedLessThan, after, end);
        builder.ins().brif(more, body, &[after.into()], next, &[]);
        builder.switch_to_block(next);
    }

    /// Copies the runs, `len` words of data.
    fn fill(&mut self, block: clif::Value, runs: clif::GlobalValue, len: usize) {
        let (pointer, flags) = (self.pointer, MemFlagsData::trusted());
        let builder = &mut *self.builder;
        let [run, word, done] = [(); 3].map(|()| builder.create_block());
        let source = builder.append_block_param(run, pointer);
        let [from, to, stop] = [(); 3].map(|()| builder.append_block_param(word, pointer));
        let start = builder.ins().symbol_value(pointer, runs);
        let end = builder.ins().iadd_imm_s(start, len as i64 * 8);
        builder.ins().jump(run, &[start.into()]);

        builder.switch_to_block(run);
        let first = builder.ins().load(pointer, flags, source, 0);
        let last = builder.ins().load(pointer, flags, source, 8);
        let target = builder.ins().iadd(block, first);
        let limit = builder.ins().iadd(block, last);
        let words = builder.ins().iadd_imm_s(source, 16);
        let args = [words.into(), target.into(), limit.into()];
        builder.ins().jump(word, &args);

        builder.switch_to_block(word);
        let value = builder.ins().load(types::I64, flags, from, 0);
        builder.ins().store(flags, value, to, 0);
        let next = builder.ins().iadd_imm_s(from, 8);
        let after = builder.ins().iadd_imm_s(to, 8);
        let more = builder.ins().icmp(IntCC::UnsignedLessThan, after, stop);
        let (again, between) = (
            [next.into(), after.into(), stop.into()],
            builder.create_block(),
        );
        builder.ins().brif(more, word, &again, between, &[]);

        builder.switch_to_block(between);
        let more = builder.ins().icmp(IntCC::UnsignedLessThan, next, end);
        builder.ins().brif(more, run, &[next.into()], done, &[]);
        builder.switch_to_block(done);
        builder.ins().return_(&[]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_tell_where_they_begin_and_end() {
        assert_eq!(runs(&[0, 0, 7, 8, 0, 9]), [16, 32, 7, 8, 40, 48, 9]);
        assert_eq!(runs(&[5, 0]), [0, 8, 5]);
    }
}
