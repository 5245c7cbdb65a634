//! Small projects made by a program: blocks and links in, a [`Project`] or the bytes of a save out.
//!
//! Owns ids and places that are the same in each run. Goes the way of real saves: objects, graph, writer; so what it
//! gives is what the reader would give. Knows no meaning of a block.

use super::objects::{Kind, Object, Objects, ROOT};
use super::project::Project;
use super::read::{self, Meta};
use super::save::Save;
use lang_text::problem::Problem;

/// A place in a sketch: a block of it.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Spot(usize);

/// A diagram in a sketch.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct DiagramId(usize);

/// Ids of a pair of objects.
#[derive(Clone, Debug)]
struct Pair {
    graphical: String,
    logical: String,
}

/// A project that grows.
#[derive(Clone, Debug)]
pub struct Sketch {
    objects: Objects,
    meta: Meta,
    sheets: Vec<Pair>,
    /// Parameters of each sheet: name, type and default.
    parameters: Vec<Vec<(String, String, String)>>,
    blocks: Vec<Pair>,
    /// On which sheet the next block is drawn.
    current: usize,
    made: u32,
}

impl Default for Sketch {
    fn default() -> Self {
        Self::new()
    }
}

impl Sketch {
    /// A project with one empty diagram, for the kit `trikV62Kit`.
    pub fn new() -> Self {
        let mut sketch = Self {
            objects: Objects::default(),
            meta: Meta::default(),
            sheets: Vec::new(),
            parameters: Vec::new(),
            blocks: Vec::new(),
            current: 0,
            made: 0,
        };
        sketch.add(Object {
            id: ROOT.to_owned(),
            parent: super::objects::NOTHING.to_owned(),
            ..Object::default()
        });
        sketch.meta("lastKitId", "trikV62Kit");
        sketch.meta(read::VERSION_KEY, read::VERSION);
        sketch.sheet("RobotsDiagramNode", "main");
        sketch
    }

    /// Adds a diagram that calls can name; what is drawn next is drawn on it. Parameters are name, type and default.
    pub fn subprogram(&mut self, name: &str, parameters: &[(&str, &str, &str)]) -> DiagramId {
        let sheet = self.sheet("SubprogramDiagram", name);
        let mut labels = String::from("<labels>");
        for (at, (name, kind, default)) in parameters.iter().enumerate() {
            let label = lang_text::xml::Element::new("label")
                .with("text", *name)
                .with("type", *kind)
                .with("value", *default)
                .with("index", at.to_string());
            labels.push_str(&lang_text::xml::write(&label, 0));
            let owned = [name, kind, default].map(|text| (*text).to_owned());
            self.parameters[sheet.0].push(owned.into());
        }
        labels.push_str("</labels>");
        let logical = self.sheets[sheet.0].logical.clone();
        self.set(&logical, Kind::Text, "labels", &labels);
        sheet
    }

    /// The main diagram.
    pub fn main(&self) -> DiagramId {
        DiagramId(0)
    }

    /// Draws the next blocks on a diagram.
    pub fn draw_on(&mut self, sheet: DiagramId) {
        self.current = sheet.0;
    }

    /// Adds a block with properties to the current diagram.
    pub fn block(&mut self, kind: &str, properties: &[(&str, &str)]) -> Spot {
        let sheet = self.sheets[self.current].graphical.clone();
        let pair = self.pair(kind, &sheet, kind);
        for (key, value) in properties {
            self.set(&pair.logical, Kind::Text, key, value);
        }
        let place = self.blocks.len();
        let position = format!("{}, {}", 100 * (place % 10), 100 * (place / 10));
        let corners = "0, 0 : 50, 0 : 50, 50 : 0, 50 : ";
        self.set(
            &pair.graphical,
            Kind::Shape("QPointF"),
            "position",
            &position,
        );
        self.set(
            &pair.graphical,
            Kind::Shape("QPolygon"),
            "configuration",
            corners,
        );
        self.blocks.push(pair);
        Spot(place)
    }

    /// Draws a block at this place, in pixels from the left and from the top of its sheet.
    pub fn place(&mut self, block: Spot, x: u16, y: u16) {
        let graphical = self.blocks[block.0].graphical.clone();
        let position = format!("{x}, {y}");
        self.set(&graphical, Kind::Shape("QPointF"), "position", &position);
    }

    /// Adds a call of a subprogram with texts of its arguments, in the order of its parameters.
    pub fn call(&mut self, sheet: DiagramId, arguments: &[&str]) -> Spot {
        let spot = self.block("Subprogram", &[]);
        let mut properties = String::from("<properties>");
        for (argument, (name, kind, _)) in arguments.iter().zip(&self.parameters[sheet.0]) {
            let property = lang_text::xml::Element::new("property")
                .with("name", name.as_str())
                .with("displayedName", name.as_str())
                .with("type", kind.as_str())
                .with("dynamicPropertyValue", *argument);
            properties.push_str(&lang_text::xml::write(&property, 0));
        }
        properties.push_str("</properties>");
        let (caller, callee) = (&self.blocks[spot.0].logical, &self.sheets[sheet.0].logical);
        let (caller, callee) = (caller.clone(), callee.clone());
        self.set(&caller, Kind::Text, "dynamicProperties", &properties);
        self.set(&caller, Kind::Id, "outgoingExplosion", &callee);
        if let Some(name) = self
            .objects
            .get(&callee)
            .and_then(|one| one.property("name"))
        {
            let name = name.to_owned();
            self.set(&caller, Kind::Text, "name", &name);
        }
        if let Some(object) = self.objects.get_mut(&callee) {
            object.list_mut("incomingExplosions").push(caller);
        }
        spot
    }

    /// Links two blocks.
    pub fn link(&mut self, from: Spot, to: Spot) {
        self.guarded(from, to, "");
    }

    /// Links two blocks by a link with a guard.
    pub fn guarded(&mut self, from: Spot, to: Spot, guard: &str) {
        self.connect(Some(from), Some(to), guard);
    }

    /// Links each block to the next.
    pub fn chain(&mut self, blocks: &[Spot]) {
        for pair in blocks.windows(2) {
            self.link(pair[0], pair[1]);
        }
    }

    /// A link whose ends may hang loose.
    pub fn connect(&mut self, from: Option<Spot>, to: Option<Spot>, guard: &str) {
        let any = from
            .or(to)
            .map(|spot| self.blocks[spot.0].graphical.clone());
        let parent = any.and_then(|id| Some(self.objects.get(&id)?.parent.clone()));
        let sheet = parent.unwrap_or_else(|| self.sheets[self.current].graphical.clone());
        let pair = self.pair("ControlFlow", &sheet, "Link");
        self.set(&pair.logical, Kind::Text, "Guard", guard);
        for (key, end) in [("from", from), ("to", to)] {
            let Some(end) = end.map(|spot| self.blocks[spot.0].clone()) else {
                continue;
            };
            self.set(&pair.logical, Kind::Id, key, &end.logical);
            self.set(&pair.graphical, Kind::Id, key, &end.graphical);
            for (block, link) in [
                (&end.logical, &pair.logical),
                (&end.graphical, &pair.graphical),
            ] {
                if let Some(object) = self.objects.get_mut(block) {
                    object.list_mut("links").push(link.clone());
                }
            }
        }
    }

    /// Gives the current diagram a property.
    pub fn diagram_property(&mut self, key: &str, value: &str) {
        let logical = self.sheets[self.current].logical.clone();
        self.set(&logical, Kind::Text, key, value);
    }

    /// Gives the save a key of its own.
    pub fn meta(&mut self, key: &str, value: &str) {
        self.meta.keys.insert(key.to_owned(), value.to_owned());
    }

    /// Gives the save a world model.
    pub fn world(&mut self, text: &str) {
        self.meta.world = Some(text.to_owned());
    }

    /// The project as the reader would give it.
    pub fn project(&self) -> Project {
        read::graph::project(&self.objects, &self.meta, &mut Vec::new())
    }

    /// The project as a save that TRIK Studio opens.
    ///
    /// # Errors
    /// More blocks than a save can have.
    pub fn qrs(&self) -> Result<Vec<u8>, Problem> {
        Save::made(self.objects.clone(), self.meta.clone()).write()
    }

    fn sheet(&mut self, kind: &str, name: &str) -> DiagramId {
        let pair = self.pair(kind, ROOT, name);
        self.sheets.push(pair);
        self.parameters.push(Vec::new());
        self.current = self.sheets.len() - 1;
        DiagramId(self.current)
    }

    /// A graphical and a logical object, listed where they belong.
    fn pair(&mut self, kind: &str, parent: &str, name: &str) -> Pair {
        let pair = Pair {
            graphical: self.id(kind),
            logical: self.id(kind),
        };
        let (graphical, logical) = (pair.graphical.clone(), pair.logical.clone());
        let (graphical, logical) = super::objects::pair(graphical, logical, parent, name);
        for (parent, object) in [(parent, graphical), (ROOT, logical)] {
            if let Some(parent) = self.objects.get_mut(parent) {
                parent.children.push(object.id.clone());
            }
            self.add(object);
        }
        pair
    }

    fn add(&mut self, object: Object) {
        let is_new = self.objects.add(object).is_ok();
        debug_assert!(is_new, "each id is made once");
    }

    fn id(&mut self, kind: &str) -> String {
        self.made += 1;
        let number = self.made;
        format!(
            "qrm:/RobotsMetamodel/RobotsDiagram/{kind}/{{00000000-0000-4000-8000-{number:012x}}}"
        )
    }

    fn set(&mut self, id: &str, kind: Kind, key: &str, value: &str) {
        if let Some(object) = self.objects.get_mut(id) {
            object.set(kind, key, value);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sketch_is_a_project() {
        let mut sketch = Sketch::new();
        let start = sketch.block("InitialNode", &[]);
        let wait = sketch.block("Timer", &[("Delay", "250")]);
        let sheet = sketch.subprogram("drive", &[("speed", "int", "50")]);
        let inner = sketch.block("InitialNode", &[]);
        let end = sketch.block("FinalNode", &[]);
        sketch.link(inner, end);
        sketch.draw_on(sketch.main());
        let call = sketch.call(sheet, &["x + 1"]);
        sketch.chain(&[start, wait, call]);
        sketch.connect(Some(call), None, "true");
        let project = sketch.project();
        assert_eq!(project.main, Some(0));
        let (main, drive) = (&project.diagrams[0], &project.diagrams[1]);
        assert_eq!(main.blocks[1].properties["Delay"], "250");
        assert_eq!(main.blocks[1].size, (50.0, 50.0));
        assert_eq!(main.blocks[0].outgoing, [0]);
        assert_eq!(main.blocks[1].incoming, [0]);
        assert_eq!((main.links[1].from, main.links[1].to), (Some(1), Some(2)));
        assert_eq!(
            (main.links[2].to, main.links[2].guard.as_str()),
            (None, "true")
        );
        let called = main.blocks[2].calls.as_deref().unwrap();
        assert_eq!(project.called(called), Some(1));
        assert_eq!(main.blocks[2].arguments[0].value, "x + 1");
        assert_eq!(drive.parameters[0].default, "50");
        assert_eq!((drive.blocks.len(), drive.links.len()), (2, 1));
    }
}
