//! Generates the parsers from the `.lalrpop` files beside the sources.

fn main() {
    // The folder, not only the files that exist now: a grammar that is added must be seen too.
    println!("cargo::rerun-if-changed=src");
    lalrpop::Configuration::new()
        .emit_rerun_directives(true)
        .use_cargo_dir_conventions()
        .process()
        .expect("the grammar files are well-formed and free of conflicts");
}
