//! Whole tables as programs write them.

use super::*;

fn rows(text: &str, format: TableFormat, columns: &[ColumnKey]) -> Result<Vec<Vec<f64>>, String> {
    let text_of = |error: SceneError| error.to_string();
    let table =
        Table::new(text.as_bytes(), Path::new("t.csv"), format, columns).map_err(text_of)?;
    let found: Result<Vec<_>, _> = columns
        .iter()
        .map(|key| table.layout().column(key))
        .collect();
    let found = found.map_err(text_of)?;
    let mut rows = table.rows();
    let mut numbers = Vec::new();
    while let Some(row) = rows.next_row().map_err(text_of)? {
        let cells = found.iter().map(|column| row.number(*column));
        let cells: Result<Vec<f64>, Fault> = cells.collect();
        numbers.push(cells.map_err(|fault| text_of(row.refused(fault)))?);
    }
    Ok(numbers)
}

/// Columns x and y of a table whose format is detected.
fn of_x_and_y(text: &str) -> Result<Vec<Vec<f64>>, String> {
    rows(text, TableFormat::default(), &["x".into(), "y".into()])
}

#[test]
fn table_in_any_layout_gives_the_same_numbers() {
    for text in [
        "x,y\n1,2\n3,4\n",
        "\u{feff}x,y\n1,2\n3,4",
        "\u{feff}# made by hand\nx,y\n1,2\n3,4",
        "# a, comment; with\ttabs\n\n x ,  y \n\n  1, 2 \n# more\n   \n3 , 4\n\n",
        "x;y\r\n1;2\r\n\r\n3;4\r\n",
        "x\ty\n1\t2\n3\t4\n",
        "x,y\r1,2\r3,4\r",
        "\"x\",\"y\"\n\"1\", \"2\"\n \" 3 \",\"4\"\n",
        "\"x;1;2;3\",x,y\n\"a;b\n;c\",1,2\n,3,4\n",
        // Blanks: aligned columns, and names of them in quotes.
        "x y\n1 2\n3 4\n",
        "  x    y  \n  1.0  2\n  3    4\n",
        "\"x\" \"y\"\n1 2\n3 4\n",
        // Delimiters at line ends, in all lines or in some.
        "x;y\n1;2;\n3;4;\n",
        "x;y;\n1;2;\n3;4;\n",
        "x,y,,,\n1,2,,,\n3,4,,,\n",
        "x,y,\n1,2\n3,4,,\n",
        // pandas: an index without a name.
        ",x,y\n0,1,2\n1,3,4\n",
        // R: names of rows, without a header or with an empty one.
        "\"x\" \"y\"\n\"1\" 1 2\n\"2\" 3 4\n",
        "\"\",\"x\",\"y\"\n\"1\",1,2\n\"2\",3,4\n",
        // numpy.savetxt: names behind #, separated like the rows or not.
        "# x y\n1.0e+00 2\n3 4\n",
        "# x,y\n1 2\n3 4\n",
        "#x,y\n1,2\n3,4\n",
        "# written on 2026-11-28\n# y z x\n2 0 1\n4 0 3\n",
        "# x y are in m\n# x, y\n# the end\n1,2\n3,4\n",
        // CloudCompare.
        "//X Y x y\n0 0 1 2\n0 0 3 4\n",
        // The line that gives the delimiter to Excel.
        "sep=;\r\nx;y\r\n1;2\r\n3;4\r\n",
        // Text in ignored columns.
        "name,x,y\n\"oak, old\",1,2\nash \"B\",3,4\n",
        "# name,x,y\noak,1,2\nash,3,4\n",
    ] {
        assert_eq!(
            of_x_and_y(text),
            Ok(vec![vec![1.0, 2.0], vec![3.0, 4.0]]),
            "{text:?}"
        );
    }
}

#[test]
fn table_with_decimal_commas_gives_the_same_numbers() {
    let format = TableFormat {
        decimal: Decimal::Comma,
        delimiter: None,
    };
    for text in [
        "x;y\n1,5;-2,25\n3;4e-1\n",
        "x\ty\r\n1,5\t-2,25\r\n3\t0,4\r\n",
        "x y\n1,5 -2,25\n3 0,4\n",
        "x,y\n\"1,5\",\"-2,25\"\n3,\"0,4\"\n",
        "# x;y\n1,5;-2,25\n3;0,4\n",
        "# x, y\n1,5 -2,25\n3,0 0,4\n",
    ] {
        let found = rows(text, format, &["x".into(), "y".into()]);
        assert_eq!(
            found,
            Ok(vec![vec![1.5, -2.25], vec![3.0, 0.4]]),
            "{text:?}"
        );
    }
    let numbers = [ColumnKey::Number(0), ColumnKey::Number(1)];
    let found = rows("1,5;2,5\n", format, &numbers);
    assert_eq!(found, Ok(vec![vec![1.5, 2.5]]));
    let message = rows("x;y\n1.5;2\n", format, &["x".into()]).expect_err("a point");
    assert!(
        message.contains("t.csv:2: column \"x\": \"1.5\""),
        "{message}"
    );
    let message = of_x_and_y("x;y\n1,5;2\n").expect_err("a comma");
    assert!(message.contains("decimal = \",\""), "{message}");
}

#[test]
fn columns_by_number_need_no_header_and_skip_one() {
    let numbers = [2, 0].map(ColumnKey::Number);
    for text in [
        "1 9 2\n3 9 4\n",
        "1,9,2\n3,9,4\n",
        "1,9,2,\n3,9,4,\n",
        "a,b,c\n1,9,2\n3,9,4\n",
        // TreeQSM names three columns at once.
        "start\tradius\n1\t9\t2\n3\t9\t4\n",
        "1 oak 2\n3 ash 4\n",
    ] {
        let found = rows(text, TableFormat::default(), &numbers);
        assert_eq!(found, Ok(vec![vec![2.0, 1.0], vec![4.0, 3.0]]), "{text:?}");
    }
    let message = rows("1,2\n", TableFormat::default(), &numbers).expect_err("two columns");
    assert!(
        message.contains("no column 2; it has 2 columns, numbered from 0"),
        "{message}"
    );
    let message = rows("1,2,3\n1,2\n", TableFormat::default(), &numbers).expect_err("short");
    assert!(
        message.contains("t.csv:2: the row has 2 cells, but the first row has 3"),
        "{message}"
    );
}

#[test]
fn row_error_names_the_line_after_any_beginning() {
    let beginnings = [
        ("x\n", 2),
        ("x\r\n", 2),
        ("x\r\n1\r\n\r\n# no\r\n\r\n", 6),
        ("\u{feff}x\n1\n\n", 4),
        ("# a\n\n# b\nx\n# c\n1\n  \n\n# d\n2\n\n\n# e\n", 14),
        ("x\n\"1\"\n\"2\"\n", 4),
        ("x,\n\"1\",\"a\nb\"\n", 4),
    ];
    for (beginning, line) in beginnings {
        for end in ["bad", "bad\n", "bad\r\n3\r\n", "bad\n\n# more\n4\n"] {
            let text = format!("{beginning}{end}");
            let message = rows(&text, TableFormat::default(), &["x".into()]);
            let message = message.expect_err("bad is not a number");
            let place = format!(":{line}: column \"x\": \"bad\" is not a number (such as 1.5");
            assert!(message.contains(&place), "{text:?}: {message}");
        }
    }
}

#[test]
fn malformed_tables_are_rejected() {
    for (text, expected) in [
        ("", "t.csv:1: the table is empty"),
        ("# x,y\n\n", "t.csv:3: the table is empty"),
        ("1,2\n", "its first line contains numbers"),
        ("x,x,y\n1,2,3\n", "more than one column \"x\""),
        ("x,Y\n1,2\n", "no column \"y\"; did you mean \"Y\"?"),
        (
            "x,y\n1,2\n1\n",
            "t.csv:3: the row has 1 cells, but the header has 2",
        ),
        (
            "x,y\n1,2,3\n",
            "t.csv:2: the row has 3 cells, but the header has 2",
        ),
        (
            "x,y\n\"1\",\"2\",\"3\"\n",
            "the row has 3 cells, but the header has 2",
        ),
        ("x,y\n1,\n", "t.csv:2: column \"y\": the cell is empty"),
        (
            "x,y\n1,NA\n",
            "t.csv:2: column \"y\": \"NA\" is not a finite number",
        ),
        (
            "x,y\n1,-inf\n",
            "t.csv:2: column \"y\": \"-inf\" is not a finite number",
        ),
        (
            "x,y\n1,\"2\n3,4\n",
            "t.csv:2: a quote opened in this row is never closed",
        ),
    ] {
        let message = of_x_and_y(text).expect_err(text);
        assert!(message.contains(expected), "{text:?}: {message}");
    }
    let wide = format!("x,y\n{}\n", "1,".repeat(MOST_COLUMNS));
    let message = of_x_and_y(&wide).expect_err("wide");
    assert!(
        message.contains("t.csv:2: the row has more than 16384 cells"),
        "{message}"
    );
}

#[test]
fn ignored_columns_are_named() {
    let unread = |text: &str| {
        let wanted = ["x".into()];
        let table = Table::new(
            text.as_bytes(),
            Path::new("t.csv"),
            TableFormat::default(),
            &wanted,
        );
        let table = table.map_err(|error| error.to_string()).expect(text);
        let x = table
            .layout()
            .column(&wanted[0])
            .map_err(|error| error.to_string());
        table.layout().unread(&[x.expect(text)])
    };
    assert_eq!(unread("x\n1\n"), None);
    assert_eq!(unread("x;\n1;\n"), None);
    assert_eq!(
        unread(",x,y,x2,\n0,1,2,3\n").as_deref(),
        Some("t.csv: ignored columns: \"y\", \"x2\", 1 without a name")
    );
    assert_eq!(
        unread("\"x\"\n\"1\" 2\n").as_deref(),
        Some("t.csv: ignored columns: 1 without a name")
    );
}

#[test]
fn name_in_any_case_counts_unless_one_matches_exactly() {
    let keys = ["x", "y"].map(ColumnKey::AnyCase);
    let of = |text| rows(text, TableFormat::default(), &keys);
    // As CloudCompare writes it.
    assert_eq!(of("//X Y Z\n1 2 0\n"), Ok(vec![vec![1.0, 2.0]]));
    assert_eq!(of("X,x,y,Y\n9,1,2,9\n"), Ok(vec![vec![1.0, 2.0]]));
    let error = of("X,y,X\n1,2,3\n").unwrap_err();
    assert!(error.contains("more than one column \"x\""), "{error}");
}

#[test]
fn row_that_begins_with_a_missing_value_is_not_a_comment() {
    let error = of_x_and_y("x,y\n#N/A,2\n").unwrap_err();
    assert!(error.starts_with("t.csv:2: column \"x\""), "{error}");
    let commented = of_x_and_y("x,y\n#N/A is a word here\n1,2\n");
    assert_eq!(commented, Ok(vec![vec![1.0, 2.0]]));
}

#[test]
fn zero_byte_in_the_first_line_is_rejected() {
    let error = of_x_and_y("x\0,\0y\0\n\0").unwrap_err();
    assert!(
        error.starts_with("t.csv:1: the first line has a zero byte"),
        "{error}"
    );
}
