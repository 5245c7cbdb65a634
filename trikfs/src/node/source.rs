//! Opening a node's source and sink.
//!
//! Owns what opening needs, and the one opening of a source that all its readers share.

use super::Node;
use crate::convert::{LogSink, Pipeline};
use crate::device::lines::answer::Answer;
use crate::device::linked::LinkedNode;
use crate::device::{ByDelivery, Device, Positions, State, Stream, Surroundings, kinds};
use crate::engine::Engine;
use crate::errno::Error;
use crate::events::{Ready, lock};
use crate::hub::Hub;
use crate::reader::{Origin, Reader};
use crate::state_reader::StateReader;
use crate::stats::Stats;
use crate::writer::Writer;
use config::description::{NodeDescription, Pace};
use std::sync::{Arc, Mutex, Weak};

/// The way to one node's device.
pub struct Source {
    pub(super) around: Surroundings,
    hub: Mutex<Weak<Hub>>,
}

/// How a node can be read.
pub type Feed = ByDelivery<StateReader, Arc<Reader>>;

/// A source that is opened for a reader, alone or shared.
type Opened = ByDelivery<Box<dyn State>, Origin>;

impl Source {
    pub(super) fn new(
        description: &NodeDescription,
        links: &[(String, Arc<Node>)],
        engine: &Engine,
        stats: &Stats,
    ) -> Self {
        let linked = links.iter().map(|(path, node)| {
            let node: Arc<dyn LinkedNode> = node.clone();
            (path.clone(), node)
        });
        let around = Surroundings {
            links: linked.collect(),
            timeout_ms: description.timeout_ms,
            damaged: stats.damaged.clone(),
            log: log_sink(engine, &description.path),
            ..Surroundings::new(engine)
        };
        Self {
            around,
            hub: Mutex::default(),
        }
    }

    /// What the sensor program of this node answered last.
    pub fn answer(&self) -> &Answer {
        &self.around.answer
    }

    /// Lines of the log that begin with the node's path.
    pub(super) fn log(&self) -> &LogSink {
        &self.around.log
    }
}

/// Lines of the log that begin with a node's path.
fn log_sink(engine: &Engine, path: &str) -> LogSink {
    let (log, path) = (engine.log.clone(), path.to_owned());
    Arc::new(move |text| log.line(&format!("{path}: {text}")))
}

impl Node {
    /// Opens the node for reading with a pipeline of its own.
    pub fn open_feed(self: &Arc<Self>, on_ready: &Arc<dyn Ready>) -> Result<Feed, Error> {
        self.open_feed_with(None, Arc::downgrade(on_ready))
    }

    /// Opens the node for reading, with a pipeline that is open or one of its own. `on_ready` is called when a stream may have
    /// more. A source that is missing is tried again and again in the background, and a state for Lua costs more than
    /// such an attempt: none is made before there is something to convert.
    pub fn open_feed_with(
        self: &Arc<Self>,
        pipeline: Option<Arc<Mutex<Pipeline>>>,
        on_ready: Weak<dyn Ready>,
    ) -> Result<Feed, Error> {
        let opened = self.open_origin(&on_ready);
        let origin = match opened.inspect_err(|error| self.report(error))? {
            Opened::State(state) => {
                let pipeline = match (pipeline, self.description.pace) {
                    (None, Pace::OnRead) => Some(self.open_pipeline()?),
                    (pipeline, _) => pipeline,
                };
                return Ok(Feed::State(StateReader::new(self.clone(), state, pipeline)));
            }
            Opened::Stream(origin) => origin,
        };
        let pipeline = pipeline.map_or_else(|| self.open_pipeline(), Ok)?;
        Ok(Feed::Stream(Reader::new(
            self.clone(),
            origin,
            pipeline,
            on_ready,
        )))
    }

    fn open_origin(self: &Arc<Self>, on_ready: &Weak<dyn Ready>) -> Result<Opened, Error> {
        let by_kind = kinds::is_shared(&self.description.source)?;
        if !self.description.share.unwrap_or(by_kind) {
            return Ok(match self.open_device()? {
                Device::State(state) => Opened::State(state),
                Device::Stream(stream) => Opened::Stream(Origin::Own(stream)),
            });
        }
        // What came before, an end included, is for the readers that were there before.
        let running = lock(&self.source.hub).upgrade();
        if let Some(hub) = running {
            hub.pump();
        }
        let mut slot = lock(&self.source.hub);
        let hub = match slot.upgrade() {
            Some(hub) => hub,
            None => match self.open_device()? {
                Device::State(state) => return Ok(Opened::State(state)),
                Device::Stream(stream) => {
                    let hub = Hub::start(self, stream);
                    *slot = Arc::downgrade(&hub);
                    hub
                }
            },
        };
        let queue = hub.subscribe(on_ready.clone());
        Ok(Opened::Stream(Origin::Shared(queue)))
    }

    fn open_device(&self) -> Result<Device, Error> {
        kinds::open(
            &self.description.source,
            self.description.input_tuple_size,
            &self.source.around,
        )
    }

    /// Opens a device that is read and written at positions; None for all that has tuples.
    pub fn open_positions(&self) -> Result<Option<Box<dyn Positions>>, Error> {
        kinds::open_positions(&self.description.source, &self.source.around)
    }

    /// Opens the source, which must be a stream: one that was a stream before.
    pub fn open_stream(&self) -> Result<Box<dyn Stream>, Error> {
        match self.open_device()? {
            Device::Stream(stream) => Ok(stream),
            Device::State(_) => Err(Error::NoDevice(
                "the source is no longer a stream".to_owned(),
            )),
        }
    }

    /// Opens the node for writing, with the pipeline of the open file or one of its own.
    pub fn open_writer(
        self: &Arc<Self>,
        pipeline: Option<Arc<Mutex<Pipeline>>>,
    ) -> Result<Writer, Error> {
        if self.driving.takes_orders() {
            return Ok(Writer::to_regulation(self.clone()));
        }
        let pipeline = pipeline.map_or_else(|| self.open_pipeline(), Ok)?;
        let sink = kinds::open_sink(&self.description.source, &self.source.around)
            .inspect_err(|error| self.report(error))?;
        Ok(Writer::new(self.clone(), sink, pipeline))
    }
}
