//! Rows of the blocks that arbitrate between streams.

use super::Content::Number;
use super::Kind::{Any, Items, List, Whole as Int};
use super::{Does, Row, input, output, property};

pub(super) const ROWS: &[Row] = &[
    Row {
        element: "DFSupressorBlock",
        shown: "Flow replacer",
        russian: "Подавление",
        size: (100, 100),
        ports: &[
            input("REPLACE_DATA", Any, 1, 30),
            input("DATA", Any, 1, 75),
            output("OUT", Any, 100, 45),
            input("TIME", Int, 65, 95),
        ],
        properties: &[property("time", "replacing time", Number, "10")],
        text: "Lets DATA through, except for the time after each token at REPLACE_DATA, which goes out at once: suppression in Brooks's sense.",
        does: Does::Replace,
    },
    Row {
        element: "DFInhibitorBlock",
        shown: "Flow delay",
        russian: "Торможение",
        size: (100, 100),
        ports: &[
            input("STOP", Any, 2, 30),
            input("DATA", Any, 2, 80),
            output("OUT", Any, 100, 45),
            input("TIME", Int, 50, 100),
        ],
        properties: &[property("time", "delay time", Number, "10")],
        text: "Lets DATA through, except for the time after each token at STOP: inhibition in Brooks's sense.",
        does: Does::Inhibit,
    },
    Row {
        element: "DFInterflowingBlock",
        shown: "Zip flows",
        russian: "Соединить потоки",
        size: (100, 100),
        ports: &[
            input("DATA1", Any, 2, 24),
            output("OUT", Items(2), 99, 48),
            input("DATA2", Any, 2, 79),
        ],
        properties: &[],
        text: "Waits for a token at both inputs and sends the two as one list.",
        does: Does::Zip,
    },
    Row {
        element: "DFSeparatorBlock",
        shown: "Unzip flows",
        russian: "Разделить поток",
        size: (100, 100),
        ports: &[
            input("DATA", List, 2, 50),
            output("OUT1", Any, 98, 26),
            output("OUT2", Any, 98, 71),
        ],
        properties: &[],
        text: "Sends the first item of each list to OUT1 and the second one to OUT2.",
        does: Does::Unzip,
    },
];
