//! Completions and manual pages.

use crate::program::cyltrace;

use std::fs;
use std::path::Path;
use std::process::Command;

#[test]
fn bash_completes_commands_options_and_values() {
    let (code, script, err) = cyltrace(Path::new("."), &["completions", "bash"]);
    assert_eq!((code, err.as_str()), (0, ""));
    for (line, expected) in [
        (&["cyltrace", "tess"][..], "tessellate"),
        (&["cyltrace", "render", "--integ"], "--integrator"),
        (&["cyltrace", "render", "--integrator", "a"], "ao"),
        (
            &["cyltrace", "bench", "traversal", "--scene", "lat"],
            "lattice",
        ),
    ] {
        let last = line.len() - 1;
        let (words, word, before) = (line.join(" "), line[last], line[last - 1]);
        let complete = format!(
            "{script}\nCOMP_WORDS=({words}); COMP_CWORD={last}\n_cyltrace cyltrace {word} {before}\necho \"${{COMPREPLY[@]}}\""
        );
        let output = Command::new("bash").args(["-c", &complete]).output();
        let output = output.expect("bash runs");
        let reply = String::from_utf8(output.stdout).expect("UTF-8");
        assert_eq!(reply.trim(), expected, "{line:?}");
    }
}

#[test]
fn completions_of_every_shell_know_every_command() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let (code, script, _) = cyltrace(Path::new("."), &["completions", shell]);
        assert_eq!(code, 0, "{shell}");
        for word in ["tessellate", "accuracy", "max-isa", "circumscribed"] {
            assert!(script.contains(word), "{shell}: no {word}");
        }
    }
    let (code, _, err) = cyltrace(Path::new("."), &["completions", "csh"]);
    assert_eq!(code, 2);
    assert!(err.contains("bash, elvish, fish, powershell, zsh"), "{err}");
}

#[test]
fn manual_has_a_page_for_every_command() {
    let folder = tempfile::tempdir().expect("a folder");
    let (code, page, _) = cyltrace(folder.path(), &["man"]);
    assert_eq!(code, 0);
    assert!(
        page.contains(".TH cyltrace 1") && page.contains("Exit codes"),
        "{page}"
    );

    let (code, out, err) = cyltrace(folder.path(), &["man", "man1"]);
    assert_eq!((code, out.as_str()), (0, ""), "{err}");
    let page = |name: &str| {
        let path = folder.path().join("man1").join(name);
        fs::read_to_string(&path).unwrap_or_else(|error| panic!("{name}: {error}"))
    };
    for (name, option) in [
        ("cyltrace-render.1", "spp"),
        ("cyltrace-trace.1", "points"),
        ("cyltrace-info.1", "layout"),
        ("cyltrace-check.1", "segments"),
        ("cyltrace-tessellate.1", "circumscribed"),
        ("cyltrace-stress.1", "promises"),
        ("cyltrace-bench-accuracy.1", "rounds"),
        ("cyltrace-bench-traversal.1", "rival"),
        ("cyltrace-bench-scale.1", "most"),
    ] {
        assert!(
            page(name).contains(&format!("\\-\\-{option}")),
            "{name}: no {option}"
        );
    }
    page("cyltrace.1");
    page("cyltrace-bench.1");
}
