//! What the guardian has to know of actuators: the bytes that bring each of them to rest, of the params of now.
//!
//! Owns these bytes for the tree in force, and when they are made anew. How they come about is known to the nodes, how they
//! reach the guardian to the ledger.

use crate::events::lock;
use crate::guardian::actions::RestAction;
use crate::guardian::ledger::Ledger;
use crate::log::Log;
use crate::node::Node;
use std::sync::{Arc, Mutex, Weak};

/// The rest of all actuators, as the guardian has it.
pub struct Rests {
    ledger: Option<Ledger>,
    log: Arc<Log>,
    noted: Mutex<Vec<Noted>>,
}

/// The rest of one actuator.
pub struct Noted {
    node: Weak<Node>,
    /// Of which params it is.
    params: u32,
    /// None: there is nothing to do.
    action: Option<RestAction>,
    /// Why it is not what it should be.
    problem: Option<String>,
}

impl Noted {
    /// What the rest of a node is with the params of now.
    fn of(node: &Arc<Node>) -> Self {
        // Before: a change meanwhile makes it one of former params.
        let params = node.params_on_the_way();
        let made = node.rest_action().map_err(|error| error.to_string());
        let made = made.and_then(|action| match action {
            Some(action) if !action.can_be_noted() => Err(
                "the guardian cannot do it when the daemon is dead: the path is too long".into(),
            ),
            made => Ok(made),
        });
        let (action, problem) = match made {
            Ok(action) => (action, None),
            Err(why) => (None, Some(format!("rest: {why}"))),
        };
        Self {
            node: Arc::downgrade(node),
            params,
            action,
            problem,
        }
    }
}

impl Rests {
    /// Nothing is to be done yet.
    pub fn new(ledger: Option<Ledger>, log: Arc<Log>) -> Arc<Self> {
        Arc::new(Self {
            ledger,
            log,
            noted: Mutex::default(),
        })
    }

    /// The rest of all these nodes that have one; what is wrong with it goes to `problems`.
    pub fn of(nodes: &[Arc<Node>], problems: &mut Vec<String>) -> Vec<Noted> {
        let actuators = nodes.iter().filter(|node| node.description.rest.is_some());
        actuators
            .map(|node| {
                let noted = Noted::of(node);
                problems.extend(
                    noted
                        .problem
                        .iter()
                        .map(|why| node.problem(why).to_string()),
                );
                noted
            })
            .collect()
    }

    /// These are the actuators of the tree from here on.
    pub fn put_in_force(&self, rests: Vec<Noted>) {
        {
            let mut noted = lock(&self.noted);
            *noted = rests;
            self.tell(&noted);
        }
        // Of params that were changed since these were made.
        self.renew();
    }

    /// Params have changed: makes anew what depends on them. No lock is held while converters run.
    pub fn renew(&self) {
        let live = |noted: &Noted| noted.node.upgrade().map(|node| (node, noted.params));
        // Outside of the lock: the last one that holds a node closes what it has.
        let mut old: Vec<_> = lock(&self.noted).iter().filter_map(live).collect();
        old.retain(|(node, params)| node.params_on_the_way() != *params);
        if old.is_empty() {
            return;
        }
        let nodes = old.iter().map(|(node, _)| node);
        let renewed: Vec<_> = nodes.map(|node| (node, Noted::of(node))).collect();
        let mut lines = Vec::new();
        {
            let mut noted = lock(&self.noted);
            let mut has_changed = false;
            for (node, new) in renewed {
                // Another one that has changed params meanwhile makes it of those.
                let mine = noted.iter_mut().find(|one| is_of(one, node));
                let is_of_now = new.params == node.params_on_the_way();
                let Some(former) = mine.filter(|_| is_of_now) else {
                    continue;
                };
                match new.problem {
                    None => {
                        has_changed |= former.action != new.action;
                        *former = new;
                    }
                    // Former bytes are better than none. The next change of a param tries again.
                    Some(why) if former.problem.as_ref() != Some(&why) => {
                        let what = format!("{why}; the guardian keeps the former one");
                        lines.push(node.problem(&what).to_string());
                        former.problem = Some(why);
                    }
                    Some(_) => {}
                }
            }
            if has_changed {
                self.tell(&noted);
            }
        }
        for line in lines {
            self.log.line(&line);
        }
    }

    fn tell(&self, noted: &[Noted]) {
        let Some(ledger) = &self.ledger else { return };
        let actions = noted.iter().filter_map(|one| one.action.clone());
        if let Err(error) = ledger.set_rest(&actions.collect::<Vec<_>>()) {
            let what = "the guardian was not told what brings the actuators to rest";
            self.log.line(&format!("{what}: {error}"));
        }
    }
}

fn is_of(noted: &Noted, node: &Arc<Node>) -> bool {
    std::ptr::eq(noted.node.as_ptr(), Arc::as_ptr(node))
}
