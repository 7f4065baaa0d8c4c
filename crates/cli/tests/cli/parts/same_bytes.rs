//! Parts that are put together have the bytes of one process.

use std::fs;
use std::path::Path;

use serde_json::Value;

use super::{SCENE, bytes, make_parts, refused, run, scene};
use crate::program::{cyltrace, words};

#[test]
fn picture_merged_from_parts_has_the_bytes_of_one_process() {
    let folder = scene();
    let folder = folder.path();
    for integrator in ["sun", "ao", "normal"] {
        let line = format!("render scene.toml --spp 3 --seed 5 --integrator {integrator}");
        // 20 tiles: more parts than tiles are empty.
        for count in [1, 7, 23] {
            make_parts(folder, &line, count);
            for picture in ["whole.png", "whole.exr"] {
                run(folder, &format!("{line} -o {picture} -q"));
                let merged = picture.replace("whole", "merged");
                run(folder, &format!("merge parts -o {merged} -q"));
                assert!(
                    bytes(folder, picture) == bytes(folder, &merged),
                    "{integrator}, {count} parts, {picture}"
                );
            }
            fs::remove_dir_all(folder.join("parts")).expect("removed");
        }
    }
}

/// The legend has an automatic range, which is known only after the scene was loaded.
#[test]
fn picture_with_a_legend_merged_from_parts_has_the_bytes_of_one_process() {
    let folder = scene();
    let folder = folder.path();
    run(folder, "render scene.toml -o plain.png -q");
    let text = fs::read_to_string(folder.join("scene.toml")).expect("the scene file");
    let table = "[[prototype.cylinder_table]]";
    let text = text.replace(table, &format!("{table}\nmaterial = \"m\""));
    let legend =
        "[[material]]\nname = \"m\"\ncolor = { column = \"r\" }\n[legend]\nmaterial = \"m\"\n";
    fs::write(folder.join("scene.toml"), legend.to_owned() + &text).expect("a scene file");
    make_parts(folder, "render scene.toml", 3);
    for picture in ["whole.png", "whole.exr"] {
        run(folder, &format!("render scene.toml -o {picture} -q"));
        run(folder, &format!("merge parts -o merged-{picture} -q"));
        assert!(
            bytes(folder, picture) == bytes(folder, &format!("merged-{picture}")),
            "{picture}"
        );
    }
    assert!(bytes(folder, "plain.png") != bytes(folder, "whole.png"));
}

/// Lines cross the edges of tiles, and opacity changes where there are any.
#[test]
fn illustrated_picture_from_parts_and_workers_has_the_bytes_of_one_process() {
    let folder = scene();
    let folder = folder.path();
    run(folder, "render scene.toml -o plain.png -q");
    let text = fs::read_to_string(folder.join("scene.toml")).expect("the scene file");
    let tables = "background = \"transparent\"\n[scale_bar]\nunit = \"m\"\n[axes]\n\
                  [outlines]\nwidth = 3\ncolor = [1, 0, 0]\n[depth_cue]\n";
    let text = text.lines().filter(|line| !line.starts_with("background"));
    let text = text.collect::<Vec<_>>().join("\n");
    fs::write(folder.join("scene.toml"), tables.to_owned() + &text).expect("a scene file");
    make_parts(folder, "render scene.toml", 3);
    for picture in ["whole.png", "whole.exr"] {
        run(
            folder,
            &format!("render scene.toml -o {picture} --threads 1 -q"),
        );
        run(folder, &format!("merge parts -o merged-{picture} -q"));
        run(
            folder,
            &format!("render scene.toml -o shared-{picture} --workers 2 --parts 5 -q"),
        );
        for other in ["merged", "shared"] {
            let other = format!("{other}-{picture}");
            assert!(bytes(folder, picture) == bytes(folder, &other), "{other}");
        }
    }
    assert!(bytes(folder, "plain.png") != bytes(folder, "whole.png"));
}

/// Rays of every kind of line end, with comments and blank lines between them.
fn rays() -> String {
    let mut text = String::from("# rays\nox,oy,oz,dx,dy,dz,note\n");
    for number in 0..500 {
        let x = f64::from(number) / 100.0 - 2.5;
        let end = ["\n", "\r\n", "\r", "\n\n", "\n# note\n"][number as usize % 5];
        text += &format!("{x},0.1,5,0,{},-1,ray {number}{end}", 0.01 * x);
    }
    text
}

#[test]
fn table_merged_from_parts_has_the_bytes_of_one_process() {
    let folder = scene();
    let folder = folder.path();
    fs::write(folder.join("rays.csv"), rays()).expect("written");
    fs::write(
        folder.join("points.csv"),
        "x y z\n0 0 0\n5 5 5\n1 0 0\n-1 0 0.5\n",
    )
    .expect("written");
    for line in [
        "trace scene.toml --rays rays.csv",
        "trace scene.toml --rays rays.csv --all",
        "trace scene.toml --points points.csv",
    ] {
        run(folder, &format!("{line} -o whole.csv -q"));
        for count in [1, 7, 40] {
            make_parts(folder, line, count);
            run(folder, "merge parts -o merged.csv -q");
            assert!(
                bytes(folder, "whole.csv") == bytes(folder, "merged.csv"),
                "{line}, {count} parts"
            );
            let merged = cyltrace(folder, &words("merge parts -o -"));
            assert_eq!(merged.1.as_bytes(), bytes(folder, "whole.csv"));
            fs::remove_dir_all(folder.join("parts")).expect("removed");
        }
    }
}

/// Every division into two parts: each place of the file is a border once.
#[test]
fn every_border_of_a_table_gives_each_row_to_one_part() {
    let folder = scene();
    let folder = folder.path();
    let table = "#a\r\nx,y,z\r\n0,0,0\r\n\r\n5,5,5\r1,0,0\n\n-1,0,0.5";
    fs::write(folder.join("points.csv"), table).expect("written");
    let line = "trace scene.toml --points points.csv";
    run(folder, &format!("{line} -o whole.csv -q"));
    let whole = bytes(folder, "whole.csv");
    let count = table.len() as u64;
    // One part for each byte: all borders are used.
    make_parts(folder, line, count);
    run(folder, "merge parts -o merged.csv -q");
    assert_eq!(
        String::from_utf8(bytes(folder, "merged.csv")),
        String::from_utf8(whole)
    );
}

#[test]
fn wrong_row_of_a_part_is_named_by_its_line_in_the_whole_table() {
    let folder = scene();
    let folder = folder.path();
    let mut table = rays().replace("\n# note\n", "\n").replace("\n\n", "\n");
    table += "0,0,0,0,0,0,no direction\r\n";
    fs::write(folder.join("rays.csv"), table).expect("written");
    let line = "trace scene.toml --rays rays.csv";
    let whole = refused(folder, &format!("{line} -o whole.csv"));
    assert!(whole.contains("rays.csv:503:"), "{whole}");
    let part = refused(folder, &format!("{line} --part 5/5 -o part"));
    assert_eq!(part, whole);
    // The other parts do not read that row.
    run(folder, &format!("{line} --part 4/5 -o part -q"));

    // A cell that continues on the next line could begin in one part and end in another.
    let quoted = "ox,oy,oz,dx,dy,dz,note\n0,0,5,0,0,-1,\"two\nlines\"\n";
    fs::write(folder.join("rays.csv"), quoted).expect("written");
    run(folder, &format!("{line} -o whole.csv -q"));
    let message = refused(folder, &format!("{line} --part 1/1 -o part"));
    assert!(
        message.contains("rays.csv:2:") && message.contains("on one line"),
        "{message}"
    );
}

/// The JSON of a check without its time, which differs from run to run.
fn without_time(folder: &Path, name: &str) -> String {
    let text = String::from_utf8(bytes(folder, name)).expect("UTF-8");
    let lines = text.lines().filter(|line| !line.contains("\"check_s\""));
    lines.collect::<Vec<_>>().join("\n")
}

#[test]
fn check_merged_from_parts_has_the_json_of_one_process() {
    let folder = scene();
    let folder = folder.path();
    let more = (0..60).map(|x| format!("[[instance]]\nof = \"twigs\"\ntranslate = [{x}, 3, 0]\n"));
    let (head, tail) = SCENE.split_once("[[prototype]]").expect("a prototype");
    let text = format!("{head}{}[[prototype]]{tail}", more.collect::<String>());
    fs::write(folder.join("scene.toml"), text).expect("written");
    // The second takes the scene in several windows.
    for memory in ["4GiB", "1MB"] {
        let line = format!("check scene.toml --rays 2500 --segments 12,32 --max-memory {memory}");
        run(folder, &format!("{line} --json whole.json -q"));
        let whole: Value = serde_json::from_slice(&bytes(folder, "whole.json")).expect("JSON");
        let windows = whole["windows"].as_array().expect("an array").len();
        assert_eq!(windows > 1, memory == "1MB", "{windows} windows");
        for count in [1, 3, 7] {
            make_parts(folder, &line, count);
            let printed = run(folder, "merge parts -o merged.json");
            assert!(printed.contains("passes: no answer is wrong"), "{printed}");
            assert_eq!(
                without_time(folder, "merged.json"),
                without_time(folder, "whole.json"),
                "{memory}, {count} parts"
            );
            fs::remove_dir_all(folder.join("parts")).expect("removed");
        }
    }
}
