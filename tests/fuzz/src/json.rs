//! Mutations of JSON as a tree: keys dropped, doubled and renamed, types swapped, branches copied, nested and repeated.

use serde_json::Value;

use crate::Random;
use crate::bytes::WORDS;

/// JSON in which a key may come twice and a number may be any text.
#[derive(Clone, Debug)]
enum Node {
    Raw(String),
    Text(String),
    List(Vec<Node>),
    Object(Vec<(String, Node)>),
}

/// Changes a JSON text; `None` where `bytes` are none.
pub(crate) fn mutate(bytes: &[u8], other: &[u8], words: &[&str], random: &mut Random) -> Option<Vec<u8>> {
    let mut tree = node(serde_json::from_slice(bytes).ok()?);
    let donor = serde_json::from_slice(other).ok().map(node);
    let mut pool = Vec::new();
    texts(&tree, &mut pool);
    pool.extend(words.iter().map(|w| (*w).to_owned()));
    for _ in 0..random.length(3) {
        let count = size(&tree);
        let piece = match &donor {
            Some(donor) if random.one_in(4) => nth(donor, &mut random.below(size(donor))).cloned(),
            _ => nth(&tree, &mut random.below(count)).cloned(),
        };
        let piece = piece.unwrap_or(Node::Raw("null".into()));
        let mut at = random.below(count);
        if let Some(target) = nth_mut(&mut tree, &mut at) {
            change(target, piece, &pool, random);
        }
        if size(&tree) > 40_000 {
            break;
        }
    }
    let mut out = String::new();
    write(&tree, &mut out);
    Some(out.into_bytes())
}

fn change(target: &mut Node, piece: Node, pool: &[String], random: &mut Random) {
    match target {
        Node::List(items) if !items.is_empty() && random.one_in(2) => {
            let (a, b) = (random.below(items.len()), random.below(items.len()));
            match random.below(6) {
                0 => drop(items.remove(a)),
                1 => items.swap(a, b),
                2 => items.insert(a, piece),
                3 => items.truncate(a),
                4 => {
                    let many = vec![items[a].clone(); random.length(256)];
                    if size(&items[a]) * many.len() < 20_000 {
                        items.splice(b..b, many);
                    }
                }
                _ => items[a] = piece,
            }
        }
        Node::Object(entries) if !entries.is_empty() && random.one_in(2) => {
            let (a, b) = (random.below(entries.len()), random.below(entries.len()));
            match random.below(7) {
                0 | 1 => drop(entries.remove(a)),
                2 => {
                    let entry = entries[a].clone();
                    entries.insert(b, entry);
                }
                3 => entries.insert(b, (text(pool, random), piece)),
                4 => entries[a].0 = text(pool, random),
                5 => {
                    let value = entries[b].1.clone();
                    entries[a].1 = value;
                }
                _ => entries[a].1 = piece,
            }
        }
        Node::Raw(_) if random.one_in(2) => *target = Node::Raw((*random.pick(&WORDS)).into()),
        Node::Text(_) if random.one_in(2) => *target = Node::Text(text(pool, random)),
        _ => {
            *target = match random.below(12) {
                0 => Node::Raw("null".into()),
                1 => Node::Raw("true".into()),
                2 => Node::Raw((*random.pick(&WORDS)).into()),
                3 => Node::Raw((random.bits() as i32 % 12).to_string()),
                4 => Node::Text(text(pool, random)),
                5 => Node::List(vec![]),
                6 => Node::Object(vec![]),
                7 => Node::List(vec![target.clone()]),
                8 => Node::Object(vec![(text(pool, random), target.clone())]),
                9 => {
                    // Deeper than a stack would like.
                    let depth = random.length(4000);
                    let (open, close) = if random.one_in(2) { ("[", "]") } else { ("{\"a\":", "}") };
                    let inner = if open == "[" { "" } else { "0" };
                    Node::Raw([open.repeat(depth).as_str(), inner, close.repeat(depth).as_str()].concat())
                }
                10 => Node::Text("long ".repeat(random.length(4000))),
                _ => piece,
            }
        }
    }
}

fn text(pool: &[String], random: &mut Random) -> String {
    match random.below(8) {
        0 => String::new(),
        1 => "\u{1f9f5}\u{0}\n\"".into(),
        _ if pool.is_empty() => "a".into(),
        2 => {
            // Nearly a name that there is.
            let mut name: Vec<char> = random.pick(pool).chars().collect();
            let at = random.below(name.len());
            name.splice(at..at, ['_']);
            name.into_iter().collect()
        }
        3 => random.pick(pool).replacen("left", "right", 1),
        _ => random.pick(pool).clone(),
    }
}

fn node(value: Value) -> Node {
    match value {
        Value::String(text) => Node::Text(text),
        Value::Array(items) => Node::List(items.into_iter().map(node).collect()),
        Value::Object(map) => Node::Object(map.into_iter().map(|(k, v)| (k, node(v))).collect()),
        other => Node::Raw(other.to_string()),
    }
}

fn size(tree: &Node) -> usize {
    1 + match tree {
        Node::List(items) => items.iter().map(size).sum(),
        Node::Object(entries) => entries.iter().map(|(_, v)| size(v)).sum(),
        _ => 0,
    }
}

/// The node number `at` in the order of the text.
fn nth<'a>(tree: &'a Node, at: &mut usize) -> Option<&'a Node> {
    if *at == 0 {
        return Some(tree);
    }
    *at -= 1;
    match tree {
        Node::List(items) => items.iter().find_map(|item| nth(item, at)),
        Node::Object(entries) => entries.iter().find_map(|(_, value)| nth(value, at)),
        _ => None,
    }
}

fn nth_mut<'a>(tree: &'a mut Node, at: &mut usize) -> Option<&'a mut Node> {
    if *at == 0 {
        return Some(tree);
    }
    *at -= 1;
    match tree {
        Node::List(items) => items.iter_mut().find_map(|item| nth_mut(item, at)),
        Node::Object(entries) => entries.iter_mut().find_map(|(_, value)| nth_mut(value, at)),
        _ => None,
    }
}

fn texts(tree: &Node, pool: &mut Vec<String>) {
    match tree {
        Node::Text(text) if text.len() < 64 => pool.push(text.clone()),
        Node::List(items) => items.iter().for_each(|item| texts(item, pool)),
        Node::Object(entries) => {
            for (key, value) in entries {
                pool.push(key.clone());
                texts(value, pool);
            }
        }
        _ => {}
    }
}

fn write(tree: &Node, out: &mut String) {
    match tree {
        Node::Raw(raw) => out.push_str(raw),
        Node::Text(text) => out.push_str(&Value::from(text.as_str()).to_string()),
        Node::List(items) => {
            out.push('[');
            for (k, item) in items.iter().enumerate() {
                if k > 0 {
                    out.push(',');
                }
                write(item, out);
            }
            out.push(']');
        }
        Node::Object(entries) => {
            out.push('{');
            for (k, (key, value)) in entries.iter().enumerate() {
                if k > 0 {
                    out.push(',');
                }
                out.push_str(&Value::from(key.as_str()).to_string());
                out.push(':');
                write(value, out);
            }
            out.push('}');
        }
    }
}
