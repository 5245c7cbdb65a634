//! Every limit of the language: what may grow, and how far.
