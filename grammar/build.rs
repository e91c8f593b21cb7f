//! Generates the parsers from the `.lalrpop` files beside the sources.

fn main() {
    lalrpop::Configuration::new()
        .emit_rerun_directives(true)
        .use_cargo_dir_conventions()
        .process()
        .expect("the grammar files are well-formed and free of conflicts");
}
