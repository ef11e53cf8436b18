//! Arguments of the verbs for what is installed beside the program.

use clap::Args;
use clap::builder::PossibleValuesParser;
use clap_complete::Shell;
use mavid::report::verbs_with_schema;
use std::path::PathBuf;

/// Arguments of `mavid completions`.
#[derive(Debug, Args)]
pub struct CompletionsArgs {
    /// the shell
    #[arg(value_enum)]
    pub shell: Shell,
}

/// Arguments of `mavid man`.
#[derive(Debug, Args)]
pub struct ManArgs {
    /// folder for a page a command
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
}

/// Arguments of `mavid schema`.
#[derive(Debug, Args)]
pub struct SchemaArgs {
    /// the verb that writes the document
    #[arg(value_parser = PossibleValuesParser::new(verbs_with_schema()))]
    pub verb: String,
}
