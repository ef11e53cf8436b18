//! Arguments of the verbs for what is installed beside the program.

use clap::Args;
use clap_complete::Shell;
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
