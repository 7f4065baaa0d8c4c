//! Tables and neurons as programs write them, through the command line and as scenes.
//! Right values are worked out by hand.

use crate::program;

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

use cyltrace::scene::{Scene, load};
use cyltrace::solid::SolidKind;
use glam::DVec3;
use program::{command, cyltrace, folder_of, words};
use tempfile::TempDir;

const SCENE: &str = "[[cylinder]]\np0 = [0, 0, -1]\np1 = [0, 0, 1]\nradius = 1\n";

/// Runs a command line in a folder.
fn run(folder: &Path, line: &str) -> (i32, String, String) {
    cyltrace(folder, &words(line))
}

/// Runs `cyltrace` in a folder with the scene and a file `table`; `line` is the command.
fn with_table(table: &str, line: &str) -> (TempDir, i32, String, String) {
    let folder = folder_of(&[
        ("scene.toml", SCENE.as_bytes()),
        ("table.csv", table.as_bytes()),
    ]);
    let (code, out, err) = run(folder.path(), line);
    (folder, code, out, err)
}

/// The columns `hit` and `t` of the hits of rays.
fn traced(table: &str, flags: &str) -> (Vec<(String, String)>, String) {
    let line = format!("trace scene.toml --rays table.csv -o - {flags}");
    let (_folder, code, out, err) = with_table(table, &line);
    assert_eq!(code, 0, "{table:?}: {err}");
    let cells = |row: &str| {
        let cells: Vec<&str> = row.split(',').collect();
        (cells[1].to_owned(), cells[2].to_owned())
    };
    (out.lines().skip(1).map(cells).collect(), err)
}

/// The ray from x = 5 meets the wall at x = 1: t is 4.
#[test]
fn rays_as_pandas_numpy_r_and_excel_write_them_meet_the_same() {
    let expected = [("1".to_owned(), "4".to_owned())];
    for (table, flags) in [
        (",ox,oy,oz,dx,dy,dz\n0,5,0,0,-1,0,0\n", ""),
        ("# ox,oy,oz,dx,dy,dz\n5,0,0,-1,0,0\n", ""),
        ("# ox oy oz dx dy dz\n5.0e+00 0.0e+00 0 -1 0 0\n", ""),
        ("5.0e+00 0.0e+00 0 -1 0 0\n", "--columns 0,1,2,3,4,5"),
        ("9,5,0,0,-1,0,0,0,inf\n", "--columns 1,2,3,4,5,6,7,8"),
        (
            "\"ox\" \"oy\" \"oz\" \"dx\" \"dy\" \"dz\"\n\"1\" 5 0 0 -1 0 0\n",
            "",
        ),
        (
            "\u{feff}ox;oy;oz;dx;dy;dz;\r\n5,0;0;0;-1,0;0;0;\r\n",
            "--decimal comma",
        ),
        ("ox|oy;oy;oz;dx;dy;dz;ox\n0;0;0;-1;0;0;5\n", "--delimiter ;"),
    ] {
        assert_eq!(traced(table, flags).0, expected, "{table:?}");
    }
}

#[test]
fn columns_that_are_not_read_are_named_once_and_not_by_the_quiet() {
    let table = ",ox,oy,oz,dx,dy,dz,t_maxx\n0,5,0,0,-1,0,0,1\n";
    let (_, err) = traced(table, "");
    let note = "note: table.csv: ignored columns: \"t_maxx\", 1 without a name\n";
    assert_eq!(err, note);
    assert_eq!(traced(table, "--quiet").1, "");
    let line = "trace scene.toml --rays table.csv -o h.csv --json -";
    let (_folder, _, out, _) = with_table(table, line);
    assert!(out.contains("ignored columns: \\\"t_maxx\\\""), "{out}");
}

#[test]
fn points_by_number_are_located() {
    let line = "trace scene.toml --points table.csv -o - --columns 2,1,0";
    let (_folder, code, out, err) = with_table("0 0 0\n0 0 5\n", line);
    let inside: Vec<_> = out
        .lines()
        .skip(1)
        .map(|row| row.split(',').nth(1))
        .collect();
    assert_eq!((code, inside), (0, vec![Some("1"), Some("0")]), "{err}");
    let line = "trace scene.toml --points table.csv -o - --columns 0,1";
    let (_folder, code, _, err) = with_table("0 0 0\n", line);
    assert!(
        code == 2 && err.contains("2 column numbers are given: 3 are needed, for x,y,z"),
        "{err}"
    );
}

#[test]
fn hits_say_yes_and_no_in_many_words() {
    let rays = "ox,oy,oz,dx,dy,dz\n5,0,0,-1,0,0\n5,5,0,-1,0,0\n";
    for hits in [
        "hit,t\nTrue,4.0\nFalse,\n",
        "hit;t\ntrue;4.0\nfalse;nan\n",
        ",ray,hit,t\n0,0.0,1.0,4\n1,1.0,0.0,inf\n",
        "\"hit\" \"t\"\n\"1\" TRUE 4\n\"2\" FALSE NA\n",
    ] {
        let folder = folder_of(&[
            ("scene.toml", SCENE.as_bytes()),
            ("rays.csv", rays.as_bytes()),
            ("hits.csv", hits.as_bytes()),
        ]);
        let (code, out, err) = run(
            folder.path(),
            "check scene.toml --rays rays.csv --hits hits.csv",
        );
        assert_eq!(code, 0, "{hits:?}: {out}{err}");
        assert_eq!(
            err.contains("note"),
            hits.starts_with(',') || hits.starts_with('"'),
            "{err}"
        );
    }
    let folder = folder_of(&[
        ("scene.toml", SCENE.as_bytes()),
        ("rays.csv", rays.as_bytes()),
        ("hits.csv", b"hit,t\nTrue,4.5\nFalse,\n"),
    ]);
    let (code, out, _) = run(
        folder.path(),
        "check scene.toml --rays rays.csv --hits hits.csv",
    );
    assert!(code == 1 && out.contains("hits.csv:2"), "{out}");
    fs::write(folder.path().join("hits.csv"), "hit,t\nTrue,NA\nFalse,\n").expect("written");
    let (code, _, err) = run(
        folder.path(),
        "check scene.toml --rays rays.csv --hits hits.csv",
    );
    assert!(
        code == 2 && err.contains("hits.csv:2: column \"t\": \"NA\""),
        "{err}"
    );
}

fn scene(files: &[(&str, &str)]) -> Result<Scene, String> {
    let files: Vec<_> = files
        .iter()
        .map(|(name, text)| (*name, text.as_bytes()))
        .collect();
    let folder = folder_of(&files);
    load(&folder.path().join("scene.toml")).map_err(|error| error.to_string())
}

/// Primitive number, ends and radius of every cylinder.
fn cylinders(scene: &Scene) -> Vec<(u32, DVec3, DVec3, f64)> {
    let records = scene.prototypes[0].solids.cylinders.iter();
    records
        .map(|record| {
            let cylinder = record.cylinder();
            (
                record.primitive(),
                cylinder.p0(),
                cylinder.p1(),
                cylinder.radius(),
            )
        })
        .collect()
}

#[test]
fn rows_without_values_are_degenerate() {
    let table = "[[cylinder_table]]\nfile = \"t.csv\"\ncolumns = { p0 = [0, 1, 2], p1 = [3, 4, 5], radius = 6 }\n";
    let rows = "0,0,0,0,0,1,0.5\n1,0,0,1,0,1,\nNA,0,0,0,0,1,1\n2,0,0,2,0,1,NaN\n3,0,0,3,0,1,1\n";
    let message = scene(&[("scene.toml", table), ("t.csv", rows)]).expect_err("an empty cell");
    assert!(
        message.contains("t.csv:2: column \"6\": the cell is empty")
            && message.contains("degenerate = \"skip\""),
        "{message}"
    );
    let skipping = format!("{table}degenerate = \"skip\"\n");
    let found = scene(&[("scene.toml", &skipping), ("t.csv", rows)]).expect("a scene");
    let at = |x| DVec3::new(x, 0.0, 0.0);
    let expected = [
        (0, at(0.0), DVec3::Z, 0.5),
        (4, at(3.0), at(3.0) + DVec3::Z, 1.0),
    ];
    assert_eq!(cylinders(&found), expected);
    assert_eq!((found.skipped_rows, found.notes.len()), (3, 0));
    let bad = rows.replace("NaN", "thick");
    let message = scene(&[("scene.toml", &skipping), ("t.csv", &bad)]).expect_err("text");
    assert!(
        message.contains("t.csv:4: column \"6\": \"thick\" is not a number (such as 1.5"),
        "{message}"
    );
}

#[test]
fn placements_and_notes_of_tables_of_a_scene() {
    let text = "[[prototype]]\nname = \"a\"\n[[prototype.sphere]]\ncenter = [0, 0, 0]\nradius = 1\n\
         [[instance_table]]\nof = \"a\"\nfile = \"p.csv\"\ndecimal = \",\"\ndelimiter = \"blanks\"\n\
         columns = { position = [\"x\", \"y\", \"z\"], scale = 4 }\n";
    let found = scene(&[
        ("scene.toml", text),
        ("p.csv", "n x y z s\n7 1,5 2 3 0,5\n"),
    ]);
    let found = found.expect("a scene");
    let placement = found.prototypes[0].placements[0].parent_from_child;
    assert_eq!(placement.translation, DVec3::new(1.5, 2.0, 3.0));
    assert_eq!(placement.matrix3.x_axis, DVec3::X * 0.5);
    assert!(
        found.notes[0].ends_with("p.csv: ignored columns: \"n\""),
        "{:?}",
        found.notes
    );
    let missing = scene(&[
        ("scene.toml", text),
        ("p.csv", "n x y z s\n7 1,5 2 NA 0,5\n"),
    ]);
    let message = missing.expect_err("no z");
    assert!(
        message.contains("p.csv:2: column \"z\": \"NA\""),
        "{message}"
    );
}

/// The solids of a neuron by kind, each with its number.
fn neuron(text: &str, keys: &str) -> Result<Vec<(SolidKind, u32)>, String> {
    let swc = format!("[[swc]]\nfile = \"n.swc\"\n{keys}");
    let found = scene(&[("scene.toml", &swc), ("n.swc", text)])?;
    let prototype = &found.prototypes[0];
    let solids = &prototype.solids;
    let mut all: Vec<(SolidKind, u32)> = Vec::new();
    all.extend(
        prototype
            .solids
            .cylinders
            .iter()
            .map(|one| (SolidKind::Cylinder, one.primitive())),
    );
    all.extend(
        solids
            .cones
            .iter()
            .map(|one| (SolidKind::Cone, one.primitive)),
    );
    all.extend(
        solids
            .rounded_cones
            .iter()
            .map(|one| (SolidKind::RoundedCone, one.primitive)),
    );
    all.extend(
        solids
            .spheres
            .iter()
            .map(|one| (SolidKind::Sphere, one.primitive)),
    );
    all.sort_by_key(|(_, number)| *number);
    Ok(all)
}

#[test]
fn neurons_in_any_layout_are_the_same() {
    let expected = vec![(SolidKind::Cylinder, 0), (SolidKind::Sphere, 1)];
    for text in [
        "1 1 0 0 0 2 -1 # root\n2 3 10 0 0 1 1\n",
        "1 1 0 0 0 2 -1#root\n2 3 10 0 0 1 1 # a # b\n",
        "1.0 1.0 0 0 0 2 -1.0\n2.0 3.0 10 0 0 1 1.0\n",
        "1,1,0,0,0,2,-1\n2,3,10,0,0,1,1\n",
        "id,type,x,y,z,radius,parent\r\n1, 1, 0, 0, 0, 2, -1\r\n2, 3, 10, 0, 0, 1, 1\r\n",
        "##n,type,x,y,z,radius,parent\n1 1 0 0 0 2 -1\n2 3 10 0 0 1 1\n",
        "n T x y z R P\n1\t1\t0\t0\t0\t2\t-1\n2\t3\t10\t0\t0\t1\t1\n",
        "\u{feff} 1 1 0 0 0 2 -1 9 8 7\n\n 2 3 10 0 0 1 1 9 8 7\n",
    ] {
        assert_eq!(neuron(text, ""), Ok(expected.clone()), "{text:?}");
    }
    for (text, message) in [
        (
            "1 1 0 0 0 2 # -1\n",
            "n.swc:1: the row has 6 cells: SWC has 7",
        ),
        (
            "1,1,0,,0,2,-1\n",
            "n.swc:1: column \"y\": \"\" is not a finite number",
        ),
        (
            "1.5 1 0 0 0 2 -1\n",
            "n.swc:1: column \"id\": \"1.5\" is not a whole number",
        ),
        (
            "1 1 0 0 0 NA -1\n",
            "n.swc:1: column \"radius\": \"NA\" is not a finite number",
        ),
        (
            "id x y z radius type parent\n1 1 0 0 0 2 -1\n",
            "n.swc:1: \"x\" is column 2: the columns of SWC are",
        ),
        (
            "1 1 0 0 0 2 -1\n1.0 1 0 0 0 2 -1\n",
            "n.swc:2: column \"id\": the id 1",
        ),
    ] {
        let found = neuron(text, "").expect_err(text);
        assert!(found.contains(message), "{text:?}: {found}");
    }
}

#[test]
fn somata_are_balls_and_cylinders_and_keep_the_numbers_of_segments() {
    let one = "1 1 5 6 7 2 -1\n2 3 15 6 7 1 1\n3 3 25 6 7 1 2\n";
    let (cylinder, sphere) = (SolidKind::Cylinder, SolidKind::Sphere);
    assert_eq!(
        neuron(one, ""),
        Ok(vec![(cylinder, 0), (cylinder, 1), (sphere, 2)])
    );
    assert_eq!(
        neuron(one, "soma = \"none\"\n"),
        Ok(vec![(cylinder, 0), (cylinder, 1)])
    );
    let found = scene(&[
        ("scene.toml", "[[swc]]\nfile = \"n.swc\"\n"),
        ("n.swc", one),
    ]);
    let ball = found.expect("a scene").prototypes[0].solids.spheres[0].solid;
    assert_eq!(
        (ball.center(), ball.radius()),
        (DVec3::new(5.0, 6.0, 7.0), 2.0)
    );

    // The ends are the children's points, the radius that of the center.
    let three = "1 1 5 6 7 2 -1\n2 1 5 4 7 2 1\n3 1 5 8 7 2 1\n4 3 15 6 7 1 1\n";
    let found = scene(&[
        ("scene.toml", "[[swc]]\nfile = \"n.swc\"\n"),
        ("n.swc", three),
    ]);
    let expected = [
        (0, DVec3::new(5.0, 4.0, 7.0), DVec3::new(5.0, 8.0, 7.0), 2.0),
        (
            2,
            DVec3::new(5.0, 6.0, 7.0),
            DVec3::new(15.0, 6.0, 7.0),
            1.0,
        ),
    ];
    assert_eq!(cylinders(&found.expect("a scene")), expected);
    let round = neuron(three, "joints = \"round\"\n");
    assert_eq!(round, Ok(vec![(cylinder, 0), (SolidKind::RoundedCone, 2)]));
    let capsules: Vec<_> = (0..3)
        .map(|number| (SolidKind::RoundedCone, number))
        .collect();
    assert_eq!(
        neuron(three, "joints = \"round\"\nsoma = \"none\"\n"),
        Ok(capsules)
    );

    let pointlike = "1 1 0 0 0 0 -1\n2 3 1 0 0 1 1\n";
    let message = neuron(pointlike, "").expect_err("no radius");
    assert!(
        message.contains("n.swc:1: column \"radius\"") && message.contains("skip"),
        "{message}"
    );
    assert_eq!(
        neuron(pointlike, "degenerate = \"skip\"\n"),
        Ok(vec![(cylinder, 0)])
    );
    let message = neuron(one, "soma = \"ball\"\n").expect_err("a word");
    assert!(message.contains("is not a value of soma"), "{message}");
}

#[cfg(unix)]
mod streams {
    use super::*;

    const TABLE: &str = "[[cylinder_table]]\nfile = \"FILE\"\ncolumns = { p0 = [0, 1, 2], p1 = [3, 4, 5], radius = 6 }\n";

    /// Runs a command on a scene whose table is standard input, which `rows` writes.
    fn from_pipe(scene: &str, line: &str, rows: impl FnOnce(&mut dyn Write)) -> (i32, String) {
        let folder = folder_of(&[("scene.toml", scene.as_bytes())]);
        let mut child = command(folder.path(), &words(line))
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program");
        rows(&mut child.stdin.take().expect("piped"));
        let output = child.wait_with_output().expect("its end");
        (
            output.status.code().unwrap_or(-1),
            String::from_utf8_lossy(&output.stderr).into_owned(),
        )
    }

    #[test]
    fn rows_of_a_pipe_are_counted_as_they_come() {
        let write = |rows: u32| {
            move |pipe: &mut dyn Write| {
                for row in 0..rows {
                    // The program may end before the rows do.
                    if writeln!(pipe, "{row} 0 0 {row} 0 1 0.25").is_err() {
                        return;
                    }
                }
            }
        };
        let table = TABLE.replace("FILE", "/dev/stdin");
        let line = "info scene.toml --max-memory 1MB";
        assert_eq!(from_pipe(&table, line, write(1000)).0, 0);
        let (code, err) = from_pipe(&table, line, write(1_000_000));
        // A million bytes are 7812 records of 64 bytes, each counted twice.
        assert!(
            code == 2 && err.contains("/dev/stdin:7813: the rows of this pipe take more memory"),
            "{err}"
        );
        let swc = "[[swc]]\nfile = \"/dev/stdin\"\n";
        let samples = |pipe: &mut dyn Write| {
            for row in 1..1_000_000 {
                if writeln!(
                    pipe,
                    "{row} 3 {row} 0 0 1 {}",
                    if row == 1 { -1 } else { row - 1 }
                )
                .is_err()
                {
                    return;
                }
            }
        };
        let (code, err) = from_pipe(swc, line, samples);
        assert!(
            code == 2 && err.contains("the rows of this pipe take more"),
            "{err}"
        );
    }

    #[test]
    fn line_that_never_ends_is_refused() {
        let zeros = |pipe: &mut dyn Write| {
            let zeros = [b'0'; 1 << 16];
            while pipe.write_all(&zeros).is_ok() {}
        };
        for (scene, line) in [
            (SCENE.to_owned(), "trace scene.toml --rays - -o -"),
            (TABLE.replace("FILE", "/dev/stdin"), "info scene.toml"),
            (
                "[[swc]]\nfile = \"/dev/stdin\"\n".to_owned(),
                "info scene.toml",
            ),
        ] {
            let (code, err) = from_pipe(&scene, line, zeros);
            assert!(
                code == 2 && err.contains(":1: the line is longer than"),
                "{line}: {err}"
            );
        }
    }

    #[test]
    fn devices_are_refused_as_tables() {
        for file in ["/dev/zero", "/dev/null"] {
            let table = TABLE.replace("FILE", file);
            let swc = format!("[[swc]]\nfile = \"{file}\"\n");
            for scene in [table, swc] {
                let folder = folder_of(&[("scene.toml", scene.as_bytes())]);
                let (code, _, err) = run(folder.path(), "info scene.toml");
                assert!(code == 2 && err.contains("it is a device"), "{err}");
            }
            let line = format!("trace scene.toml --rays {file} -o -");
            let (_folder, code, _, err) = with_table("", &line);
            assert!(code == 2 && err.contains("it is a device"), "{err}");
        }
    }

    #[test]
    fn named_pipes_are_read_once_they_have_a_writer_and_refused_without() {
        let folder = folder_of(&[("scene.toml", SCENE.as_bytes())]);
        let pipe = folder.path().join("pipe");
        let made = Command::new("mkfifo").arg(&pipe).status().expect("mkfifo");
        assert!(made.success());
        let (code, _, err) = run(folder.path(), "trace scene.toml --rays pipe -o -");
        assert!(
            code == 2 && err.contains("no program has written to"),
            "{err}"
        );
        let table = TABLE.replace("FILE", "pipe");
        fs::write(folder.path().join("table.toml"), table).expect("written");
        let (code, _, err) = run(folder.path(), "info table.toml");
        assert!(
            code == 2 && err.contains("no program has written to"),
            "{err}"
        );

        let path: &Path = &pipe;
        std::thread::scope(|scope| {
            scope.spawn(|| fs::write(path, "ox,oy,oz,dx,dy,dz\n5,0,0,-1,0,0\n").expect("read"));
            let (code, out, err) = run(folder.path(), "trace scene.toml --rays pipe -o -");
            assert!(
                code == 0 && out.lines().count() == 2 && out.contains("0,1,4,"),
                "{out}{err}"
            );
        });
    }
}
