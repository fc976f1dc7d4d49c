//! Slurm: an array job runs the shards, and a dependent job merges them.
//!
//! An array task restarts a killed program, and the program resumes its shard. Slurm requeues the tasks of a failed
//! node. The merge waits until all tasks have succeeded.

use std::path::Path;
use std::process::Command;

use serde_json::json;

use super::Submission;
use super::shards::Commands;
use crate::arguments::Sweep;
use crate::error::{Error, Result};
use crate::output::write_file;

/// Maximum number of times that an array task starts a program that is killed.
const ATTEMPTS: u8 = 5;

/// Writes the scripts to the output folder and submits them.
pub fn submit(options: &Sweep) -> Result<Submission> {
    let commands = Commands::new(options)?;
    let folder = commands.folder.join("slurm");
    let (shards, merge) = (folder.join("shards.sh"), folder.join("merge.sh"));
    write_file(&shards, shards_script(&commands).as_bytes())?;
    write_file(&merge, merge_script(&commands).as_bytes())?;
    let array = format!("--array=1-{}", commands.count);
    let array = sbatch(
        &folder,
        &[
            &array,
            "--requeue",
            "--open-mode=append",
            "--output=shard_%a.log",
        ],
        &shards,
    )?;
    let after = format!("--dependency=afterok:{array}");
    let merge = sbatch(
        &folder,
        &[&after, "--kill-on-invalid-dep=yes", "--output=merge.log"],
        &merge,
    )?;
    let count = commands.count;
    Ok(Submission {
        document: json!({ "engine": "slurm", "shards": count, "array_job": array, "merge_job": merge }),
        text: format!(
            "array job {array} with {count} shards, then job {merge}, which merges them\n\
             status: squeue -j {array},{merge}; output: {}/shard_*.log\n",
            folder.display()
        ),
    })
}

/// Submits a script and returns the job number.
fn sbatch(folder: &Path, options: &[&str], script: &Path) -> Result<String> {
    let output = Command::new("sbatch")
        .args(["--parsable", "--job-name=eomgen_sweep"])
        .args(options)
        .arg("--chdir")
        .arg(folder)
        .arg(script)
        .output()
        .map_err(|error| {
            Error::input(format!(
                "--engine slurm: cannot run sbatch ({error}); run this command on a machine that submits jobs to Slurm"
            ))
        })?;
    let said = String::from_utf8_lossy(&output.stdout);
    // If Slurm has several clusters, `;CLUSTER` follows the job number.
    let job = said.trim().split(';').next().unwrap_or_default();
    if output.status.success() && !job.is_empty() && job.bytes().all(|byte| byte.is_ascii_digit()) {
        return Ok(job.to_owned());
    }
    Err(Error::input(format!(
        "--engine slurm: sbatch refused {}: {}",
        script.display(),
        String::from_utf8_lossy(&output.stderr).trim()
    )))
}

fn shards_script(commands: &Commands) -> String {
    let words = std::iter::once(&commands.program).chain(&commands.sweep);
    let command: Vec<String> = words.map(|word| quote(word)).collect();
    let threads = match commands.threads {
        Some(threads) => threads.to_string(),
        None => "\"${SLURM_CPUS_PER_TASK:-1}\"".to_owned(),
    };
    format!(
        "#!/bin/sh\n\
         # Runs a shard of a sweep as an array task. A killed program is restarted and resumes its shard.\n\
         attempt=1\n\
         until {} --threads {threads} --shard \"$SLURM_ARRAY_TASK_ID/{}\"; do\n    \
             status=$?\n    \
             if [ \"$status\" -le 128 ] || [ \"$attempt\" -ge {ATTEMPTS} ]; then exit \"$status\"; fi\n    \
             attempt=$((attempt + 1))\n\
         done\n",
        command.join(" "),
        commands.count
    )
}

fn merge_script(commands: &Commands) -> String {
    format!(
        "#!/bin/sh\n# Merges the shards of a sweep.\nexec {} merge {}\n",
        quote(&commands.program),
        quote(&commands.out)
    )
}

/// Quotes a word for a shell.
pub fn quote(word: &str) -> String {
    format!("'{}'", word.replace('\'', r"'\''"))
}

#[cfg(test)]
mod tests {
    use std::process::Command;

    use super::quote;

    #[test]
    fn quoted_words_pass_through_a_shell_unchanged() {
        for word in ["a b", "it's", "$HOME `ls` \"x\" \\", "", "''", "*;&|<>"] {
            let script = format!("printf %s {}", quote(word));
            let output = Command::new("sh").args(["-c", &script]).output();
            let output = output.expect("a shell");
            assert_eq!(String::from_utf8_lossy(&output.stdout), word);
        }
    }
}
