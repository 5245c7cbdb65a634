//! Tuples of a node through its converters.
//!
//! Owns what a conversion means for the node: it is counted and timed, and a fault of it becomes the node's. What a
//! pipeline does is `convert`'s business.

use super::Node;
use crate::clock::Stamp;
use crate::convert::{Batch, Pipeline};
use crate::errno::Error;
use converter::Direction;
use std::sync::{Arc, Mutex};

impl Node {
    /// A private pipeline of converters.
    pub fn open_pipeline(&self) -> Result<Arc<Mutex<Pipeline>>, Error> {
        let pipeline = self
            .recipe
            .open(self.source.log())
            .inspect_err(|error| self.report(error))?;
        Ok(Arc::new(Mutex::new(pipeline)))
    }

    /// Converts, counts and times. A fault in the result is reported already.
    pub fn convert(
        &self,
        pipeline: &mut Pipeline,
        direction: Direction,
        input: &[u8],
        output: &mut [u8],
    ) -> Batch {
        if let Err(error) = self.recipe.renew(pipeline, || self.source.log().clone()) {
            self.report(&error);
            return Batch {
                consumed: 1,
                produced: 0,
                fault: Some(error),
            };
        }
        let start = self.stats.measures_this_conversion().then(Stamp::now);
        let mut batch = pipeline.convert(direction, input, output);
        if direction == Direction::Read {
            batch.fault = batch.fault.map(Error::of_reading);
        }
        if let Some(start) = start
            && batch.consumed > 0
        {
            let each_ns = start.age_ns() / batch.consumed as u64;
            self.stats.conversion.add(each_ns);
        }
        if let Some(error) = &batch.fault {
            self.report(error);
        } else if self.trouble.has_fault() {
            self.recover();
        }
        batch
    }
}
