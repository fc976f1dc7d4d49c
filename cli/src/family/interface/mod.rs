//! Common interface of all variants of a family: a trait in Rust, tables of function pointers in C.

/// Returns the Rust source of the trait and its implementations for these modules.
pub fn rust<'n>(modules: impl Iterator<Item = &'n str>) -> String {
    let lines = modules.map(|module| format!("implement_model!({module});\n"));
    format!(
        "\n{}\n{}",
        include_str!("model.rs"),
        lines.collect::<String>()
    )
}

/// C source of a variant in double precision.
pub struct CVariant<'n> {
    /// Folder of the variant.
    pub folder: &'n str,
    /// Prefix of the C names.
    pub prefix: String,
}

/// Returns the C header and source with the tables of these variants.
pub fn c(family: &str, variants: &[CVariant<'_>]) -> [String; 2] {
    let lines = |line: &dyn Fn(&CVariant<'_>) -> String| -> String {
        variants
            .iter()
            .map(|variant| line(variant) + "\n")
            .collect()
    };
    let declarations = lines(&|CVariant { prefix, .. }| {
        format!("/** Table of `{prefix}`. */\nextern const eomgen_model {prefix}_model;")
    });
    let includes =
        lines(&|CVariant { folder, prefix }| format!("#include \"{folder}/{prefix}.h\""));
    let tables = lines(&|CVariant { prefix, .. }| format!("TABLE({prefix})"));
    let header = include_str!("models.h").replace("DECLARATIONS\n", &declarations);
    let source = include_str!("models.c").replace("INCLUDES\n", &includes) + &tables;
    [header, source].map(|text| text.replace("FAMILY", family))
}
