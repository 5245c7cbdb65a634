throw "just a text";
//! just a text
