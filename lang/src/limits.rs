//! Every limit of the language: what may grow, and how far.

/// Bytes of a save as it comes, in any container.
pub const SAVE_BYTES: usize = 32 << 20;
/// Bytes of all entries of a save, unpacked.
pub const SAVE_UNPACKED_BYTES: usize = 48 << 20;
/// Bytes of one unpacked entry: the largest real ones are embedded images.
pub const ENTRY_BYTES: usize = 24 << 20;
/// Entries of a save; the largest real one has 1500. What a zip without extensions can count.
pub const ENTRIES: usize = 65_535;
/// Bytes of an entry's name.
pub const ENTRY_NAME_BYTES: usize = 1024;
/// How deep tags may nest in a document.
pub const XML_DEPTH: usize = 64;
/// Tags of one document.
pub const XML_TAGS: usize = 100_000;
/// Attributes of one tag.
pub const XML_ATTRIBUTES: usize = 64;
/// Objects that all lists of a save may name together; an object is named about four times.
pub const REFERENCES: usize = 300_000;
/// Problems that one reading tells; what is more is counted.
pub const PROBLEMS: usize = 200;
/// Problems that are counted.
pub const PROBLEMS_KEPT: usize = 2_000;

/// Bytes of one expression's text.
pub const EXPRESSION_TEXT_MAX: usize = 64 << 10;
/// How deep an expression may nest, and how many operators of one precedence may stand in a row.
pub const EXPRESSION_DEPTH_MAX: u16 = 200;
/// Problems that are told of one text; more of them help nobody.
pub const EXPRESSION_PROBLEMS_MAX: usize = 50;
/// How often types are inferred anew because a variable was widened.
pub const EXPRESSION_PASSES_MAX: usize = 64;
/// Names of one project: variables, ports, functions.
pub const NAMES_MAX: usize = 4096;
/// Types of table elements that are still open, in one project.
pub const OPEN_TYPES_MAX: usize = 16 << 10;
/// Elements of one table.
pub const LIST_MAX: usize = 100_000;
/// Tables in tables.
pub const LIST_DEPTH_MAX: u16 = 32;
/// Cells of one value: an element of a table, or 16 bytes of text.
pub const VALUE_CELLS_MAX: u32 = 500_000;
/// Cells of all variables of a project.
pub const STORE_CELLS_MAX: u32 = 1_000_000;
/// Bytes of one text value.
pub const TEXT_MAX: usize = 1 << 20;
/// Bytes of a text value that can be a number.
pub const NUMBER_TEXT_MAX: usize = 1000;
/// Cells that one evaluation may compare, copy or make.
pub const EVALUATION_CELLS_MAX: u32 = 4_000_000;
/// Blocks of a project that is run.
pub const NODES_MAX: usize = 2_000_000;
/// Threads that live at the same time, as in the original.
pub const THREADS_MAX: usize = 100;
/// Calls of subprograms that have not returned, as in the original.
pub const STACK_MAX: usize = 4000;
/// Messages that wait for one thread.
pub const MESSAGES_MAX: usize = 10_000;
/// Names of threads that one fork remembers.
pub const FORK_NAMES_MAX: usize = 10_000;
/// How many diamonds one condition of a generated program may stand for.
pub const CONDITION_TESTS_MAX: usize = 8;
/// How many statements a structured program may have for each block, because of copies.
pub const COPIES_PER_BLOCK: usize = 2;
/// And beside that.
pub const COPIES_FREE: usize = 64;
/// How deep branches and loops of a structured program may nest.
pub const NESTING_MAX: usize = 40;
/// How deep its loops may nest; Python allows 20.
pub const LOOPS_NESTING_MAX: usize = 12;
/// How deep branches of one state nest in a program over states.
pub const STATES_NESTING_MAX: usize = 6;
/// Blocks of a project that is written as text.
pub const GENERATED_BLOCKS_MAX: usize = 20_000;
/// Functions of a program that is written as text.
pub const GENERATED_FUNCTIONS_MAX: usize = 1000;
/// How deep an expression may nest that is written as text.
pub const GENERATED_DEPTH_MAX: usize = 100;
/// Blocks of one picture.
pub const PICTURE_BLOCKS_MAX: usize = 5000;
/// Corners of one link in a picture.
pub const PICTURE_CORNERS_MAX: usize = 64;
/// How deep tags of constraints may nest, with templates put in.
pub const CONSTRAINT_DEPTH_MAX: usize = 64;
/// Tags of constraints, with templates put in.
pub const CONSTRAINT_TAGS_MAX: usize = 100_000;
/// Events and constraints of one field.
pub const CONSTRAINT_EVENTS_MAX: usize = 10_000;
/// Bytes of all templates, each as often as it is put in.
pub const TEMPLATE_TEXT_MAX: usize = 4 << 20;
/// How deep templates may use templates.
pub const TEMPLATE_DEPTH_MAX: usize = 32;
/// Entries of one report that are no verdict.
pub const CONSTRAINT_ENTRIES_MAX: usize = 10_000;
/// Different errors of rules that are remembered, and errors of one event that are told.
pub const CONSTRAINT_COMPLAINTS_MAX: usize = 100;
/// Bytes of one message with its places filled.
pub const CONSTRAINT_MESSAGE_BYTES: usize = 64 << 10;

/// Bytes of a DCML document.
pub const DCML_TEXT_MAX: usize = 32 << 20;
/// How deep the tree of an expression of DCML may be: its nesting, and operators in a row.
pub const DCML_DEPTH: usize = 500;

/// Axes of the metric of a planner.
pub const PLAN_AXES_MAX: usize = 64;
/// States, outputs and actions of a model that is planned for.
pub const PLAN_NUMBERS_MAX: usize = 4096;
/// Steps for which a planner holds an action.
pub const PLAN_HOLD_MAX: u32 = 1_000_000;
/// Samples of one search.
pub const PLAN_ITERATIONS_MAX: u64 = 4_000_000_000;
/// Places of one search.
pub const PLAN_NODES_MAX: usize = 4_000_000;
/// Numbers of all places of one search: 8 bytes each.
pub const PLAN_MEMORY_NUMBERS: usize = 128 << 20;
/// Samples between two reports of progress.
pub const PLAN_REPORT_EVERY: u64 = 64;
/// Poses of a goal that are looked at before it is refused.
pub const PLAN_GOAL_TRIES: u32 = 4096;
/// Obstacles of one plan.
pub const PLAN_OBSTACLES_MAX: usize = 1_000_000;
/// Corners of all obstacles of one plan.
pub const PLAN_CORNERS_MAX: usize = 4_000_000;
/// Bytes of a text with obstacles.
pub const PLAN_OBSTACLES_TEXT_MAX: usize = 128 << 20;
/// Coordinates of obstacles go so far from zero.
pub const PLAN_COORDINATE_MAX: f64 = 1e9;
/// Poses between two steps of a solver; a robot that moves further than so many resolutions is refused.
pub const PLAN_SWEEP_STEPS_MAX: u32 = 100_000;
/// Operations of one tape of a model, before those that nobody needs are gone.
pub const DCML_OPERATIONS_MAX: usize = 1 << 20;
/// Elements of a Jacobian of a model.
pub const DCML_JACOBIAN_MAX: usize = 1 << 20;
/// Steps of differentiation: operations that depend on an input, for all inputs together.
pub const DCML_JACOBIAN_STEPS_MAX: usize = 1 << 24;
/// Values that a batch of states keeps for each state at the same time.
pub const DCML_BATCH_ROWS_MAX: usize = 1 << 16;
/// Values and results of a model that is written in Java, whose methods end at 64 KiB.
pub const DCML_JAVA_VALUES: usize = 3000;
/// The same in Lua, whose functions end at 65536 constants.
pub const DCML_LUA_VALUES: usize = 30_000;
/// Steps of one solution of a model.
pub const DCML_STEPS_MAX: usize = 10_000_000;
/// Events of one solution of a model.
pub const DCML_EVENTS_MAX: usize = 100_000;
/// Words and signs of a document.
pub const DCML_TOKENS: usize = 4_000_000;
/// Errors of a document that are told, and as many warnings.
pub const DCML_DIAGNOSTICS: usize = 200;
/// Names among which the nearest to a mistyped one is looked for.
pub const DCML_WORDS_COMPARED: usize = 2000;
/// Bytes of a name that may be a mistyped one.
pub const DCML_WORD_COMPARED_BYTES: usize = 64;
/// Names of a loop, and bytes of a word, that a message shows.
pub const DCML_SHOWN: usize = 40;
/// Bytes of a document of which an editor learns more than what is wrong with it.
pub const DCML_EDITOR_BYTES: usize = 8 << 20;
/// Places, coloured words and entries of an outline that an editor gets at once.
pub const DCML_EDITOR_PLACES: usize = 200_000;
/// Words that are offered at once.
pub const DCML_EDITOR_OFFERS: usize = 1000;
/// Findings of one stretch for which edits are offered.
pub const DCML_EDITOR_FIXES: usize = 50;
/// Words in which the call is looked for whose arguments are written.
pub const DCML_EDITOR_LOOK_BACK: usize = 10_000;
/// Bytes of a name that an outline shows, and of one that is put in by an editor.
pub const DCML_EDITOR_NAME_BYTES: usize = 250;
/// Bytes of a documentation or an equation that are shown.
pub const DCML_EDITOR_SHOWN_BYTES: usize = 2000;
