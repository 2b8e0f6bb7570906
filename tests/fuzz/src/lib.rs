//! Mutation fuzzing of readers: whatever the bytes, a reader answers soon, in little memory, with something sound or a
//! typed error.
//!
//! A [`Reader`] is a function from bytes to a [`Reading`], with valid files to start from. [`fuzz`] changes these in ways
//! that know text, JSON and containers, runs the reader on every result under a watchdog and a counting allocator, and
//! keeps inputs whose outcome is new as further files to start from. Everything follows from the seed.
//!
//! `tests/readers` holds the readers of the libraries; those of the command line are tested beside them in `cli`.
//! A test run takes seconds. `TOILE_FUZZ_SECONDS=600 cargo test --release -p fuzz -- --nocapture` gives every reader ten
//! minutes, `TOILE_FUZZ_SEED` other numbers. A find is mended and its input becomes a named test.

mod bytes;
mod glb;
mod json;
mod memory;
mod random;

use std::collections::BTreeSet;
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::sync::{Arc, Mutex, mpsc};
use std::time::{Duration, Instant};

pub use bytes::LONGEST;
pub use memory::CountingAllocator;
pub use random::Random;

/// Time after which a reader hangs: what it is given is at most [`LONGEST`] bytes.
pub const HANG: Duration = Duration::from_secs(2);

/// Most inputs of either outcome kept to start from.
const CORPUS: usize = 3000;

/// How a reader's files are built, so that changes get past their first bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Bytes, words and lines.
    Bytes,
    /// JSON.
    Json,
    /// glTF: JSON, or JSON and bytes in a container.
    Gltf,
}

/// What a reader made of an input.
#[derive(Clone, Debug)]
pub enum Reading {
    /// Something sound; sizes that tell one result from another.
    Sound(Vec<usize>),
    /// A typed error, in words.
    Refused(String),
}

/// What is under test.
pub type Read = Box<dyn Fn(&[u8]) -> Reading + Send>;

/// A reader under test.
pub struct Reader {
    /// Name in reports.
    pub name: &'static str,
    /// How its files are built.
    pub shape: Shape,
    /// Valid files.
    pub seeds: Vec<Vec<u8>>,
    /// Words of the format.
    pub words: &'static [&'static str],
    /// Inputs of a short run.
    pub inputs: u64,
    /// Memory that it may take: so many bytes, …
    pub base_memory: usize,
    /// … and so many for every byte of the input.
    pub memory_factor: usize,
    /// The reader with the checks of what it returns; it panics where that is not sound.
    pub read: Read,
}

/// An input that a reader does not survive.
#[derive(Clone, Debug)]
pub struct Find {
    /// What happened.
    pub what: String,
    /// Where the input lies.
    pub file: PathBuf,
}

/// What became of a run.
#[derive(Clone, Debug)]
pub struct Report {
    /// The reader.
    pub name: &'static str,
    /// Wall-clock seconds.
    pub seconds: f64,
    /// Inputs read.
    pub inputs: u64,
    /// How many of them were refused.
    pub refused: u64,
    /// Different outcomes seen.
    pub outcomes: usize,
    /// Longest time for one input.
    pub slowest: Duration,
    /// Most memory in use for one input, bytes.
    pub peak: usize,
    /// Most memory in use for every byte of an input of 1 KiB or more.
    pub peak_factor: f64,
    /// Inputs that the reader did not survive.
    pub finds: Vec<Find>,
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{:<13} {:>6.1} s {:>10} inputs {:>10} refused {:>5} outcomes, slowest {:>6.1} ms, \
             peak {:>6.2} MiB, {:>5.1} bytes a byte, {} finds",
            self.name,
            self.seconds,
            self.inputs,
            self.refused,
            self.outcomes,
            1e3 * self.slowest.as_secs_f64(),
            self.peak as f64 / f64::from(1 << 20),
            self.peak_factor,
            self.finds.len()
        )?;
        for find in &self.finds {
            write!(f, "\n  {}: {}", find.file.display(), find.what)?;
        }
        Ok(())
    }
}

/// Where inputs of finds are put.
pub(crate) fn finds_folder() -> PathBuf {
    let folder = std::env::temp_dir().join("toile-fuzz");
    // Where it cannot be made, the write that follows says so.
    let _ = std::fs::create_dir_all(&folder);
    folder
}

/// What the watchdog sees of the worker.
#[derive(Default)]
struct Watched {
    /// Number of the input being read, from 1.
    number: AtomicU64,
    input: Mutex<Vec<u8>>,
    /// File in which the system counts the worker's time on a core.
    clock: Mutex<Option<PathBuf>>,
}

impl Watched {
    /// Seconds that the worker has had a core.
    fn busy(&self) -> Option<f64> {
        let path = self.clock.lock().ok()?.clone()?;
        let text = std::fs::read_to_string(path).ok()?;
        Some(text.split_whitespace().next()?.parse::<f64>().ok()? / 1e9)
    }
}

/// Runs a reader on changed files: `TOILE_FUZZ_SECONDS` long, else as many as the reader's short run has.
///
/// One at a time in a process, so that each has a core to itself.
pub fn fuzz(reader: Reader, allocator: &'static CountingAllocator) -> Report {
    static ONE: Mutex<()> = Mutex::new(());
    let _one = ONE.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let variable = |name: &str| std::env::var(name).ok().and_then(|value| value.parse::<u64>().ok());
    let seconds = variable("TOILE_FUZZ_SECONDS").map(Duration::from_secs);
    let seed = variable("TOILE_FUZZ_SEED").unwrap_or(1);
    let name = reader.name;
    let watched = Arc::new(Watched::default());
    let (send, receive) = mpsc::channel();
    let start = Instant::now();
    let worker = watched.clone();
    quiet_panics();
    let work = move || send.send(work(&reader, allocator, &worker, seconds, seed));
    std::thread::Builder::new().name(WORKER.into()).spawn(work).expect("a thread can be started");
    // The input seen at the last look, when it was first seen, and the worker's time on a core then.
    let mut seen = (0, Instant::now(), None);
    loop {
        match receive.recv_timeout(Duration::from_millis(50)) {
            Ok(report) => return report,
            Err(mpsc::RecvTimeoutError::Disconnected) => panic!("{name}: the harness itself failed"),
            Err(mpsc::RecvTimeoutError::Timeout) => {}
        }
        let number = watched.number.load(Relaxed);
        if number != seen.0 || number == 0 {
            seen = (number, Instant::now(), watched.busy());
            continue;
        }
        // A busy machine may keep the worker waiting; that is no hang. A reader that sleeps for a minute is one.
        let waited = seen.1.elapsed();
        let worked = match (seen.2, watched.busy()) {
            (Some(then), Some(now)) if waited < 30 * HANG => Duration::from_secs_f64((now - then).max(0.0)),
            _ => waited,
        };
        if worked > HANG {
            let input = watched.input.lock().map(|input| input.clone()).unwrap_or_default();
            let what = format!("hangs: more than {worked:.1?} on {} bytes", input.len());
            let finds = vec![keep(name, &input, what)];
            let (inputs, seconds) = (number, start.elapsed().as_secs_f64());
            let (refused, outcomes, peak, peak_factor) = (0, 0, 0, 0.0);
            return Report {
                name,
                seconds,
                inputs,
                refused,
                outcomes,
                slowest: worked,
                peak,
                peak_factor,
                finds,
            };
        }
    }
}

/// Panics of readers are caught and reported once; everybody else's are told as ever.
fn quiet_panics() {
    static ONCE: std::sync::Once = std::sync::Once::new();
    ONCE.call_once(|| {
        let tell = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            if std::thread::current().name() == Some(WORKER) {
                let place = info.location().map(|l| format!("{}:{}", l.file(), l.line())).unwrap_or_default();
                PANIC.with(|last| last.replace(place));
            } else {
                tell(info);
            }
        }));
    });
}

/// Name of the thread on which readers run.
const WORKER: &str = "reader under test";

thread_local! {
    /// Where the last panic was.
    static PANIC: std::cell::RefCell<String> = const { std::cell::RefCell::new(String::new()) };
}

fn keep(name: &str, input: &[u8], what: String) -> Find {
    let hash =
        input.iter().fold(0xcbf2_9ce4_8422_2325u64, |h, b| (h ^ u64::from(*b)).wrapping_mul(0x100_0000_01b3));
    let file = finds_folder().join(format!("{name}-{hash:016x}.bin"));
    let what = match std::fs::write(&file, input) {
        Ok(()) => what,
        Err(error) => format!("{what} (the input could not be kept: {error})"),
    };
    Find { what, file }
}

fn work(
    reader: &Reader,
    allocator: &CountingAllocator,
    watched: &Watched,
    seconds: Option<Duration>,
    seed: u64,
) -> Report {
    if let Ok(mut clock) = watched.clock.lock() {
        let of = |task: PathBuf| PathBuf::from("/proc").join(task).join("schedstat");
        *clock = std::fs::read_link("/proc/thread-self").ok().map(of);
    }
    let mut run = Run {
        reader,
        allocator,
        watched,
        outcomes: BTreeSet::new(),
        failures: BTreeSet::new(),
        sound: reader.seeds.clone(),
        refused: Vec::new(),
        report: Report {
            name: reader.name,
            seconds: 0.0,
            inputs: 0,
            refused: 0,
            outcomes: 0,
            slowest: Duration::ZERO,
            peak: 0,
            peak_factor: 0.0,
            finds: Vec::new(),
        },
    };
    let start = Instant::now();
    for seed in &reader.seeds {
        let refused = run.report.refused;
        run.one(seed.clone());
        if run.report.refused > refused {
            run.report.finds.push(keep(reader.name, seed, "a valid file is refused".into()));
        }
    }
    let mut random = Random(seed);
    let mut rounds = 0;
    while seconds.map_or(rounds < reader.inputs, |s| start.elapsed() < s) && run.report.finds.len() < 100 {
        let input = run.next(&mut random);
        run.one(input);
        rounds += 1;
    }
    run.report.seconds = start.elapsed().as_secs_f64();
    run.report.outcomes = run.outcomes.len();
    run.report
}

struct Run<'a> {
    reader: &'a Reader,
    allocator: &'a CountingAllocator,
    watched: &'a Watched,
    outcomes: BTreeSet<String>,
    failures: BTreeSet<String>,
    /// Files that were found sound, and those refused in a way of their own.
    sound: Vec<Vec<u8>>,
    refused: Vec<Vec<u8>>,
    report: Report,
}

impl Run<'_> {
    fn next(&self, random: &mut Random) -> Vec<u8> {
        let of = |random: &mut Random| {
            let all =
                if self.refused.is_empty() || random.below(8) < 5 { &self.sound } else { &self.refused };
            // Half of the time what was found last: where there is something new there is often more.
            let fresh = if random.one_in(2) { all.len().saturating_sub(32) } else { 0 };
            &all[fresh + random.below(all.len() - fresh)]
        };
        let (mut input, other) = (of(random).clone(), of(random));
        let words = self.reader.words;
        let shaped = match self.reader.shape {
            _ if random.one_in(4) => None,
            Shape::Bytes => None,
            Shape::Json => json::mutate(&input, other, words, random),
            Shape::Gltf => glb::mutate(&input, other, words, random)
                .or_else(|| json::mutate(&input, other, words, random)),
        };
        match shaped {
            Some(changed) => input = changed,
            None => bytes::mutate(&mut input, other, words, random),
        }
        input.truncate(LONGEST);
        input
    }

    fn one(&mut self, input: Vec<u8>) {
        if let Ok(mut current) = self.watched.input.lock() {
            current.clone_from(&input);
        }
        self.report.inputs += 1;
        self.watched.number.store(self.report.inputs, Relaxed);
        let start = Instant::now();
        let (outcome, peak) =
            self.allocator.measure(&input, || catch_unwind(AssertUnwindSafe(|| (self.reader.read)(&input))));
        let took = start.elapsed();
        self.report.slowest = self.report.slowest.max(took);
        self.report.peak = self.report.peak.max(peak);
        if input.len() >= 1 << 10 {
            self.report.peak_factor = self.report.peak_factor.max(peak as f64 / input.len() as f64);
        }
        let (kept, outcome) = match outcome {
            Ok(Reading::Sound(sizes)) => (&mut self.sound, {
                format!("{:?}", sizes.iter().map(|s| s.checked_ilog2()).collect::<Vec<_>>())
            }),
            Ok(Reading::Refused(words)) => {
                self.report.refused += 1;
                // A message may quote from the file, once.
                if words.is_empty() || words.len() > 1000 + input.len() {
                    self.find(&input, &format!("a message of {} bytes", words.len()));
                }
                (&mut self.refused, kind(&words))
            }
            Err(payload) => {
                let words = payload
                    .downcast_ref::<String>()
                    .map(String::as_str)
                    .or_else(|| payload.downcast_ref::<&str>().copied())
                    .unwrap_or("?");
                let place = PANIC.with(std::cell::RefCell::take);
                self.find(&input, &format!("panics at {place}: {words}"));
                return;
            }
        };
        let allowed = self.reader.base_memory + self.reader.memory_factor * input.len();
        let greedy = peak > allowed;
        if self.outcomes.insert(outcome) && kept.len() < CORPUS {
            kept.push(input.clone());
        }
        if greedy {
            self.find(&input, &format!("takes {peak} bytes of memory for an input of {}", input.len()));
        }
    }

    /// Keeps the input, once for every kind of failure.
    fn find(&mut self, input: &[u8], what: &str) {
        if self.failures.insert(kind(what)) {
            self.report.finds.push(keep(self.reader.name, input, what.chars().take(300).collect()));
        }
    }
}

/// A message without its numbers and without what it quotes.
fn kind(words: &str) -> String {
    let mut out = String::new();
    let mut quoted = None;
    for c in words.chars() {
        match quoted {
            Some(quote) if c == quote => quoted = None,
            Some(_) => continue,
            None if matches!(c, '`' | '\'' | '"') => quoted = Some(c),
            None if c.is_ascii_digit() => continue,
            None => out.push(c),
        }
        if out.len() > 200 {
            break;
        }
    }
    out
}
