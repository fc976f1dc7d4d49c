//! Tests of shell completions and man pages.

use eomgen_tests::program::{run, run_accepted, run_rejected, text};

fn commands() -> Vec<String> {
    let help = run_accepted(&["--help"]);
    let (_, list) = help.split_once("Commands:\n").expect("a list of commands");
    let (list, _) = list.split_once("\n\n").expect("its end");
    let name = |line: &str| {
        let indented = line.strip_prefix("  ")?;
        let named = !indented.starts_with(' ');
        named.then(|| indented.split(' ').next().unwrap_or_default().to_owned())
    };
    let names: Vec<String> = list.lines().filter_map(name).collect();
    assert!(names.contains(&"simulate".to_owned()), "{help}");
    names
}

#[test]
fn completions_of_every_shell_contain_commands_and_options() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = run_accepted(&["completions", shell]);
        for command in commands() {
            assert!(script.contains(&command), "{shell}: {command}");
        }
        for option in ["tolerance", "mode-shapes", "certify"] {
            assert!(script.contains(option), "{shell}: {option}");
        }
    }
    assert!(run_rejected(&["completions", "cmd"]).contains("powershell"));
}

#[test]
fn bash_completes_an_option() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("eomgen");
    std::fs::write(&file, run_accepted(&["completions", "bash"])).expect("a file");
    // Requests the completions of `eomgen simulate --sol`.
    let script = format!(
        "source {} && COMP_WORDS=(eomgen simulate --sol) COMP_CWORD=2 && \
         _eomgen eomgen --sol simulate && echo \"${{COMPREPLY[@]}}\"",
        file.display()
    );
    let Ok(output) = std::process::Command::new("bash")
        .args(["-c", &script])
        .output()
    else {
        skips::skip("bash completions were not tested: bash is missing");
        return;
    };
    assert_eq!(text(&output.stdout).trim(), "--solver", "{output:?}");
}

#[test]
fn man_pages_of_all_commands_have_an_example() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("man1");
    let said = run_accepted(&["man", "--out", &out.display().to_string()]);
    let commands: Vec<String> = commands()
        .into_iter()
        .filter(|name| name != "help")
        .collect();
    assert!(
        said.ends_with(&format!(": {} pages\n", commands.len() + 1)),
        "{said}"
    );
    let page = |name: &str| {
        std::fs::read_to_string(out.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    };
    for command in commands {
        let page = page(&format!("eomgen-{command}.1"));
        assert!(
            page.contains(".TH eomgen-") && page.contains("Example"),
            "{page}"
        );
        assert!(
            page.contains(&format!("eomgen {}", command.replace('-', "\\-"))),
            "{page}"
        );
    }
    assert!(page("eomgen.1").contains("eomgen\\-simulate(1)"));
}

#[test]
fn man_pages_do_not_replace_a_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("taken");
    std::fs::write(&file, "mine").expect("a file");
    let output = run(&["man", "--out", &file.display().to_string()]);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        text(&output.stderr).contains("is not a folder"),
        "{output:?}"
    );
    assert_eq!(std::fs::read_to_string(&file).expect("the file"), "mine");
}
