//! Reading a table of rays or points, block by block.

use std::ops::Range;
use std::path::Path;

use anyhow::anyhow;
use cyltrace::scene::{NumberRow, NumberTable, SceneError};
use rayon::prelude::*;

use super::arguments::FormatArguments;
use super::interrupt;

/// Blocks per thread in each batch: enough to even out slow ones.
const BLOCKS_PER_THREAD: usize = 4;

/// A table of rays or points.
pub struct NumberRows<'a> {
    pub path: &'a Path,
    pub format: &'a FormatArguments,
    /// Only the rows that begin in these bytes of the table.
    pub range: Option<Range<u64>>,
}

impl NumberRows<'_> {
    /// Reads the table in the current rayon pool and calls `action` with the rows of some
    /// blocks at a time, in order. Returns a note if there are columns that are not read.
    pub fn for_each_batch<R: NumberRow>(
        &self,
        mut action: impl FnMut(Vec<Vec<R>>) -> anyhow::Result<()>,
    ) -> anyhow::Result<Option<String>> {
        let (path, format) = (self.path, self.format.format());
        let columns = &self.format.columns;
        let table = match &self.range {
            Some(range) => NumberTable::<R>::open_range(path, format, columns, range.clone()),
            None => NumberTable::<R>::open(path, format, columns),
        };
        // The error's text is the whole message; its source would repeat a part.
        let message = |error: SceneError| anyhow!("{error}");
        let mut table = table.map_err(message)?;
        let columns = table.columns();
        loop {
            interrupt::check()?;
            let mut blocks = Vec::new();
            while blocks.len() < BLOCKS_PER_THREAD * rayon::current_num_threads() {
                let block = table.next_block();
                let Some(block) = block.map_err(message)? else {
                    break;
                };
                blocks.push(block);
            }
            if blocks.is_empty() {
                return Ok(columns.unread());
            }
            // Collected first, then searched for an error, so that the first invalid row is
            // reported.
            let parsed: Vec<_> = blocks.par_iter().map(|block| columns.rows(block)).collect();
            let parsed: Result<_, _> = parsed.into_iter().collect();
            action(parsed.map_err(message)?)?;
        }
    }
}
