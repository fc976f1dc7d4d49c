//! Slurm: the shards as an array job, and a job behind it that merges.
//!
//! An element whose program is killed begins it again, and finds the parts that are there; one whose
//! node is lost is put into the queue again by Slurm. The merge waits until all have succeeded.

use std::path::Path;
use std::process::Command;

use serde_json::json;

use super::Submitted;
use super::shards::Commands;
use crate::arguments::Sweep;
use crate::error::{Error, Result};
use crate::output::write_file;

/// How often an element begins a program that is killed.
const ATTEMPTS: u8 = 5;

/// Writes the scripts beside the parts, and submits them.
pub fn submit(options: &Sweep) -> Result<Submitted> {
    let commands = Commands::of(options)?;
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
    Ok(Submitted {
        document: json!({ "engine": "slurm", "shards": count, "array_job": array, "merge_job": merge }),
        text: format!(
            "array job {array} of {count} shards, and job {merge} that merges after it\n\
             squeue -j {array},{merge} shows them, {}/shard_*.log what they say\n",
            folder.display()
        ),
    })
}

/// Submits a script; the number of its job.
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
                "--engine slurm: sbatch cannot be run here ({error}); it is there on machines that submit jobs to Slurm"
            ))
        })?;
    let said = String::from_utf8_lossy(&output.stdout);
    // With several clusters the name of one comes behind the number.
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
    let command: Vec<String> = words.map(|word| quoted(word)).collect();
    let threads = match commands.threads {
        Some(threads) => threads.to_string(),
        None => "\"${SLURM_CPUS_PER_TASK:-1}\"".to_owned(),
    };
    format!(
        "#!/bin/sh\n\
         # A shard of a sweep: an element of an array job. A program that is killed is begun again, and\n\
         # finds the parts that it had left.\n\
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
        "#!/bin/sh\n# The parts of a sweep to its table and pictures.\nexec {} merge {}\n",
        quoted(&commands.program),
        quoted(&commands.out)
    )
}

/// A word that a shell leaves as it is.
fn quoted(word: &str) -> String {
    format!("'{}'", word.replace('\'', r"'\''"))
}

#[cfg(test)]
mod tests {
    use std::process::Command;

    use super::quoted;

    #[test]
    fn a_shell_gives_quoted_words_back() {
        for word in ["a b", "it's", "$HOME `ls` \"x\" \\", "", "''", "*;&|<>"] {
            let script = format!("printf %s {}", quoted(word));
            let output = Command::new("sh").args(["-c", &script]).output();
            let output = output.expect("a shell");
            assert_eq!(String::from_utf8_lossy(&output.stdout), word);
        }
    }
}
