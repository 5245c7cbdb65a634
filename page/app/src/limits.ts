// Limits of what comes to the page from outside.
//
// Owns the numbers only; the code that enforces each one names it from here. How much a view keeps and how it is laid out stands
// with the view, and what a format or the protocol says stands with what reads it.

/** Bytes of a recording, and of the last minutes of a robot, which are 16 MiB unless its `trikd` is told otherwise. */
export const FILE_BYTES_MAX = 64 << 20;
/** Bytes of one record, and of what comes out of a chunk. */
export const RECORD_BYTES_MAX = 16 << 20;
/** Bytes that come out of one compressed byte: lz4 reaches 255. */
export const INFLATION_MAX = 256;
/** Bytes that come out of all chunks. */
export const INFLATED_BYTES_MAX = 1 << 30;
/** Channels that are looked at, as the recorder makes them at most. */
export const CHANNELS_MAX = 8192;
/** Bytes of the text of a message type. */
export const SCHEMA_BYTES_MAX = 256 << 10;
/** Fields of a message type that are looked at. */
export const SCHEMA_FIELDS_MAX = 1024;
/** Numbers of a recording that are kept, of eight bytes each. */
export const NUMBERS_MAX = 16 << 20;
/** Bytes of texts, lines and pictures of a recording that are kept. */
export const TEXT_BYTES_MAX = 64 << 20;
/** What a text costs besides its letters. */
export const TEXT_COST = 64;
/** The page does something else after so much reading. */
export const SLICE_MS = 30;
/** A robot that sends nothing for so long will not. */
export const SILENCE_MS = 15_000;
/** Letters that are shown of a value of a recorded diagram. */
export const VALUE_LETTERS_MAX = 1000;
/** How much later than the other one a recording may be shown that is compared: a day. */
export const OFFSET_S_MAX = 86_400;
/** Values within the time in which two runs may differ; what comes so often says nothing there. */
export const NEAR_VALUES_MAX = 256;
/** Differences of two recordings that are listed. */
export const DIFFERENCES_MAX = 200;

/** Bytes of a program that the control port takes, less its name. */
export const PROGRAM_BYTES_MAX = (16 << 20) - 1024;
/** Bytes of a program that the server gives to an editor. */
export const EDITED_BYTES_MAX = 128 << 10;
/** Bytes of a configuration that the filesystem takes. */
export const CONFIGURATION_BYTES_MAX = 1 << 20;
/** Converters of a chain, as the filesystem takes them. */
export const CHAIN_MAX = 16;
/** Turned numbers of converters that can be taken back. */
export const TURNS_MAX = 200;
/** Megabytes of a file with a world. The server takes 6 MiB of an order, and Base64 has four letters for three bytes. */
export const WORLD_FILE_MB_MAX = 4;
/** Nodes that are sampled while they are shown: as many patterns as the control port takes. */
export const WANTED_PATHS_MAX = 64;
/** Orders to the debugger that wait for their answers; the robot takes 256. */
export const ORDERS_WAITING_MAX = 100;

/** Items of each list that the debugger tells: ports, of which the robot keeps 1000, variables, threads. */
export const TOLD_ITEMS_MAX = 1000;
/** Letters of a name in it, and of an id of a block. */
export const TOLD_NAME_LETTERS_MAX = 1000;
/** Bytes of the pictures of a program. */
export const SHEETS_BYTES_MAX = 32 << 20;
/** Elements of a picture: a thousand blocks of data flow with many ports. */
export const PICTURE_ELEMENTS_MAX = 60_000;
/** Letters of a token that stand in the picture; all of it stands beside the picture. */
export const TOKEN_LETTERS_MAX = 12;
/** Ports that are listed beside the picture; those of one block are listed when it is chosen. */
export const PORTS_LISTED_MAX = 60;

/** Fields of a format that are looked at. */
export const FORMAT_FIELDS_MAX = 4096;
/** Numbers of one node that are shown one by one. */
export const FIELDS_SHOWN_MAX = 1024;
/** Numbers of one graph: as many as it has colours for. */
export const GRAPH_NUMBERS_MAX = 8;
/** More samples than this of one number are thinned out, with the least and the greatest of each stretch kept. */
export const DRAWN_MAX = 1500;
/** Nodes and graphs of a dashboard. */
export const PINNED_MAX = 60;
/** Letters of a path or a name in the store of the browser. */
export const STORED_NAME_LENGTH_MAX = 1024;

/** Bytes of what stands still in a recorded world; the recorder has the same limit. */
export const SCENE_BYTES_MAX = 256 << 10;
/** Worlds of one recording that are kept: each that a person has loaded is one. */
export const SCENES_MAX = 100;
/** Items of a recorded world, and points of each. */
export const SCENE_ITEMS_MAX = 20_000;
/** Things that move in it, and rays of a lidar. */
export const THINGS_MAX = 1000;
/** Points of ways in one recorded world that are kept. */
export const PAST_POINTS_MAX = 1 << 20;
/** Lines before a moment that are tried if they say nothing of a world. */
export const PLACES_TRIED_MAX = 100;
/** Robots of it, and wheels and sensors of each. */
export const SHAPE_PARTS_MAX = 100;
/** A question stays for so long at most: a timer of the browser has 31 bits of milliseconds. */
export const QUESTION_S_MAX = 86_400;
/** Times, names and the checksum of an attachment of a recording. */
export const ATTACHED_WORDS_BYTES = 1024;
/** A project that the studio opens. */
export const EDIT_FILE_MB_MAX = 32;
/** A project in an address: what browsers take and messengers carry. */
export const LINK_KIB_MAX = 48;
/** After the last change, before mistakes are looked for. */
export const LOOK_AFTER_MS = 30;
/** After the last change, before a robot that runs the drawing gets it. */
export const DRAWN_AFTER_MS = 200;
/** After the last change, before the browser keeps the project. */
export const KEEP_AFTER_MS = 500;
/** What is pasted stands beside its original. */
export const PASTE_SHIFT_PX = 25;
/** Lines of what a run has said that are kept. */
export const SAID_LINES_MAX = 500;
/** A program with text that the studio opens. */
export const SCRIPT_FILE_MB_MAX = 1;
/** Pictures of a run of it, one for each 20 ms, that are kept: ten minutes. */
export const PICTURES_MAX = 30_000;
/** A program that asks its robot for nothing for so long is ended; its engine may take longer to come. */
export const SILENT_MS_MAX = 10_000;
export const ENGINE_MS_MAX = 120_000;
/** Runs with other random numbers, one after the other on each core. */
export const MANY_RUNS_MAX = 500;
export const MANY_WORKERS_MAX = 8;
/** Moments of a run that are kept, of which each has the places of all that moves. */
export const RUN_MOMENTS_MAX = 12_000;
/** Numbers of a moment: variables, motors and sensors. */
export const RUN_NUMBERS_MAX = 64;
/** Letters of a condition, and of what a breakpoint writes: the debugger takes no more. */
export const CONDITION_LETTERS_MAX = 1000;
/** Cells of a heat map along the longer side of a world. */
export const HEAT_CELLS_MAX = 400;
/** Fields in which a program is run many times. */
export const FIELDS_MAX = 30;
/** Projects of a folder that are listed, and entries of it that are looked at. */
export const FOLDER_FILES_MAX = 200;
export const FOLDER_ENTRIES_MAX = 5000;
/** Letters of a world that the studio edits: as many bytes as a part of a project may have. */
export const XML_LETTERS_MAX = 32 << 20;
/** Tags of it, and how deep they stand, as the reader of worlds takes them. */
export const XML_TAGS_MAX = 100_000;
export const XML_DEPTH_MAX = 64;
/** Things of a world that are drawn to be edited; all of them are in the picture of the run. */
export const WORLD_DRAWN_MAX = 3000;
/** Tags of rules that are shown as forms; more are edited as text. */
export const RULE_FORMS_MAX = 2000;
/** After the last letter, before rules that are typed are taken. */
export const RULES_AFTER_MS = 400;
/** Megabytes of a file that becomes a picture of a world. */
export const PICTURE_FILE_MB_MAX = 32;
/** Pixels of it: each one takes four bytes while it is made smaller. */
export const PICTURE_PIXELS_MAX = 64 << 20;
/** Bytes of a picture as it is kept: larger ones are made smaller. A floor takes 4 MiB. */
export const PICTURE_BYTES_MAX = 2 << 20;
/** Pixels of its longer side. */
export const PICTURE_SIDE_PX_MAX = 2000;
/** Pieces of what is drawn by hand at once. */
export const STROKES_MAX = 2000;
/** Blocks of a sheet on which links go around others: each link is held against all of them. */
export const DETOUR_BLOCKS_MAX = 1000;
