//! Element names of saves before 2016-07-12, with how their ports were numbered.
//!
//! Owns the list. A former port is known by the name of the present one; one that there is no more has its former name.

/// An element name that is no longer written.
#[derive(Debug)]
pub struct Former {
    /// The former name.
    pub element: &'static str,
    /// The present one.
    pub now: &'static str,
    /// What the property [`SHAPE`] says of those that have become this one, if it has become several.
    pub shape: Option<&'static str>,
    /// Names of the present ports by former numbers; `None`: the numbers are the same.
    pub ports: Option<&'static [&'static str]>,
}

/// The property that says what a painter of shapes draws.
pub const SHAPE: &str = "shapeType";
/// Blocks that drew any shape. The second one was in no version that anybody could draw with, so its ports are not known.
pub(super) const PAINTERS: [&str; 2] = ["ShapePainter", "DFShapePainterBlock"];

const fn same(element: &'static str, now: &'static str) -> Former {
    Former {
        element,
        now,
        shape: None,
        ports: None,
    }
}

const fn other(element: &'static str, now: &'static str, ports: &'static [&'static str]) -> Former {
    Former {
        element,
        now,
        shape: None,
        ports: Some(ports),
    }
}

/// A painter drew what a list of numbers said, and had a block for each shape later. How CONFIG said a colour is not known.
const fn painter(shape: &'static str, now: &'static str) -> Former {
    Former {
        element: PAINTERS[0],
        now,
        shape: Some(shape),
        ports: Some(&["CF_OUT", "CONFIG", "COORDS"]),
    }
}

/// A fork gave a unit for each token: it made no thread. A function without texts does the same.
const fn fork(element: &'static str) -> Former {
    other(element, "DFFunctionBlock", &["CF_IN", "CF_OUT"])
}

/// All of them.
pub(super) const FORMER: &[Former] = &[
    same("FinalNode", "DFFinalBlock"),
    same("Function", "DFFunctionBlock"),
    same("IfNode", "DFIfBlock"),
    same("Switch", "DFSwitchBlock"),
    same("Loop", "DFLoopBlock"),
    same("SubprogramCall", "DFUserBlock"),
    same("InPort", "DFInPortBlock"),
    same("OutPort", "DFOutPortBlock"),
    same("ValueEmitter", "DFValueEmitterBlock"),
    same("GetSetVariable", "DFGetSetVariableBlock"),
    same("RandomValue", "DFRandomValueBlock"),
    same("Supressor", "DFSupressorBlock"),
    same("Inhibitor", "DFInhibitorBlock"),
    same("ConcreteOutputPort", "DFConcreteOutputPortBlock"),
    same("PlayTone", "DFPlayToneBlock"),
    same("SystemCallNode", "DFSystemCallBlock"),
    same("StreamingNode", "DFStreamingBlock"),
    same("InitCamera", "DFInitCameraBlock"),
    same("DetectByVideo", "DFDetectByVideoBlock"),
    same("WriteToFile", "DFWriteToFileBlock"),
    same("ReadFile", "DFReadFileBlock"),
    same("RemoveFile", "DFRemoveFileBlock"),
    same("WaitNode", "DFWaitBlock"),
    same("DFReceiveMsgBlock", "ReceiveMsg"),
    same("Gamepad", "DFGamepadBlock"),
    same("PaintSettings", "DFPaintSettingsBlock"),
    same("SmilePainter", "DFSmilePainterBlock"),
    same("ClearNode", "DFClearScreenBlock"),
    same("SensorVar", "DFSensorVarBlock"),
    same("Interflowing", "DFInterflowingBlock"),
    same("Separator", "DFSeparatorBlock"),
    other(
        "Motors",
        "DFMotorsBlock",
        &["M1", "M2", "CF_OUT", "M3", "M4"],
    ),
    other("Servo", "DFServoBlock", &["S1", "S2", "S3", "S4", "CF_OUT"]),
    other(
        "Encoders",
        "DFEncodersBlock",
        &[
            "E1_IN", "E2_IN", "E3_IN", "E4_IN", "E1_OUT", "E2_OUT", "E3_OUT", "E4_OUT",
        ],
    ),
    other("SayNode", "DFSayBlock", &["CF_OUT", "DATA"]),
    other("LedNode", "DFLedBlock", &["CF_OUT", "DATA"]),
    other(
        "ConcreteInputPort",
        "DFConcreteInputPortBlock",
        &["CF_OUT", "DATA"],
    ),
    other(
        "TextOnScreen",
        "DFTextOnScreenBlock",
        &["CF_OUT", "COORDS", "TEXT"],
    ),
    other("Pen", "DFPenBlock", &["CF_OUT", "UP_DOWN", "COLOR"]),
    other(
        "MessageToRobot",
        "DFMessageToRobotBlock",
        &["CF_OUT", "MSG", "NUMBER"],
    ),
    same("DelayFilterNode", "DFDelayFilterBlock"),
    fork("ForkNode"),
    fork("EndFork"),
    painter("point", "DFDrawPixelBlock"),
    painter("line", "DFDrawLineBlock"),
    painter("rectangle", "DFDrawRectBlock"),
    painter("ellipse", "DFDrawCircleTrikBlock"),
    painter("arc", "DFDrawArcTrikBlock"),
];
