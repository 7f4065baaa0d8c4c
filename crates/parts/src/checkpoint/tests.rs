//! Checkpoints that are cut off, changed, foreign or in use.

use super::*;
use crate::file::tests::header;

const LINE_FEED: u8 = b'\n';

/// A checkpoint with five units in two records, and unit 3 empty.
fn written(path: &Path) -> Vec<u8> {
    let checkpoint = Checkpoint::open(path, &header(1, 1)).expect("new");
    assert_eq!(checkpoint.earlier_units(), 0);
    for unit in [7, 3] {
        checkpoint.add(unit, &content(unit));
    }
    checkpoint.flush();
    for unit in [0, 99, 12] {
        checkpoint.add(unit, &content(unit));
    }
    checkpoint.flush();
    assert_eq!(checkpoint.failure(), None);
    drop(checkpoint);
    fs::read(path).expect("read")
}

fn content(unit: u64) -> Vec<u8> {
    (0..(unit * 7) % 21).map(|byte| byte as u8).collect()
}

/// The units of a checkpoint, each with the bytes that it should have.
fn units(checkpoint: &Checkpoint) -> Vec<u64> {
    let units = (0..100).filter(|&unit| checkpoint.earlier(unit).is_some());
    let units: Vec<u64> = units.collect();
    for &unit in &units {
        assert_eq!(checkpoint.earlier(unit), Some(content(unit)), "unit {unit}");
    }
    assert_eq!(units.len() as u64, checkpoint.earlier_units());
    units
}

#[test]
fn checkpoint_goes_on_where_it_was_left() {
    let directory = tempfile::tempdir().expect("directory");
    let path = directory.path().join("checkpoint");
    written(&path);
    let checkpoint = Checkpoint::open(&path, &header(1, 1)).expect("valid");
    assert_eq!(units(&checkpoint), [0, 3, 7, 12, 99]);
    checkpoint.add(50, &content(50));
    checkpoint.flush();
    drop(checkpoint);
    let checkpoint = Checkpoint::open(&path, &header(1, 1)).expect("valid");
    assert_eq!(units(&checkpoint), [0, 3, 7, 12, 50, 99]);
    assert_eq!(checkpoint.dropped_bytes(), 0);
    checkpoint.remove().expect("removed");
    assert!(!path.exists());
}

/// The length of the line of the header.
fn first_line(bytes: &[u8]) -> usize {
    let end = bytes.iter().position(|&byte| byte == LINE_FEED);
    end.expect("a line") + 1
}

#[test]
fn every_cut_keeps_the_records_before_it() {
    let directory = tempfile::tempdir().expect("directory");
    let path = directory.path().join("checkpoint");
    let bytes = written(&path);
    let line = first_line(&bytes);
    // Two units in the first record.
    let second = line + 40 + 2 * UNIT + content(7).len() + content(3).len();
    for cut in 0..bytes.len() {
        fs::write(&path, &bytes[..cut]).expect("written");
        let checkpoint = Checkpoint::open(&path, &header(1, 1)).expect("valid");
        let (expected, end): (&[u64], _) = match cut {
            _ if cut < second => (&[], line),
            _ => (&[3, 7], second),
        };
        assert_eq!(units(&checkpoint), expected, "cut at {cut}");
        let dropped = cut.saturating_sub(end);
        assert_eq!(checkpoint.dropped_bytes(), dropped as u64, "cut at {cut}");
        // What is added now is found again.
        checkpoint.add(5, &content(5));
        checkpoint.flush();
        drop(checkpoint);
        let checkpoint = Checkpoint::open(&path, &header(1, 1)).expect("valid");
        assert_eq!(checkpoint.earlier(5), Some(content(5)), "cut at {cut}");
        assert_eq!(checkpoint.earlier_units(), expected.len() as u64 + 1);
    }
}

#[test]
fn every_changed_byte_is_noticed() {
    let directory = tempfile::tempdir().expect("directory");
    let path = directory.path().join("checkpoint");
    let bytes = written(&path);
    let line = first_line(&bytes);
    for at in 0..bytes.len() {
        let mut changed = bytes.clone();
        changed[at] ^= 1;
        fs::write(&path, &changed).expect("written");
        match Checkpoint::open(&path, &header(1, 1)) {
            Ok(checkpoint) => {
                assert!(at >= line, "byte {at} of the first line");
                assert!(units(&checkpoint).len() < 5, "byte {at}");
                assert!(checkpoint.dropped_bytes() > 0, "byte {at}");
            }
            Err(_) => {
                assert!(at < line, "byte {at}");
                // It is left as it is.
                assert_eq!(fs::read(&path).expect("read"), changed);
            }
        }
    }
}

#[test]
fn other_files_and_checkpoints_are_left_as_they_are() {
    let directory = tempfile::tempdir().expect("directory");
    let path = directory.path().join("checkpoint");
    let message = |header: &Header| {
        let error = Checkpoint::open(&path, header).expect_err("another file");
        error.to_string()
    };
    for text in ["\n", "scene", &"x".repeat(10_000)] {
        fs::write(&path, text).expect("written");
        let message = message(&header(1, 1));
        assert!(message.contains("is not a checkpoint"), "{message}");
        assert_eq!(fs::read(&path).expect("read"), text.as_bytes());
    }
    fs::remove_file(&path).expect("removed");
    written(&path);
    let mut other = header(1, 1);
    other.settings["spp"] = 16.into();
    let text = message(&other);
    assert!(text.contains("its spp is 4, not 16"), "{text}");
    let mut other = header(1, 1);
    other.fingerprint = "another".into();
    let text = message(&other);
    assert!(text.contains("has another content"), "{text}");

    let checkpoint = Checkpoint::open(&path, &header(1, 1)).expect("valid");
    let text = message(&header(1, 1));
    assert!(text.contains("another run"), "{text}");
    drop(checkpoint);
    assert!(Checkpoint::open(&path, &header(1, 1)).is_ok());
}
