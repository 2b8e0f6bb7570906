//! An allocator that counts, so that a test can say how much memory a reader took at most.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::atomic::{AtomicPtr, AtomicUsize, Ordering::Relaxed};

thread_local! {
    /// Bytes in use by this thread: what it took less what it gave back, whoever had taken that.
    static OWN: Cell<isize> = const { Cell::new(0) };
    /// The most that were.
    static OWN_PEAK: Cell<isize> = const { Cell::new(0) };
}

/// Changes the thread's count. A thread that is ending counts no more.
fn count(change: isize) {
    let _ = OWN.try_with(|own| {
        own.set(own.get() + change);
        let _ = OWN_PEAK.try_with(|peak| peak.set(peak.get().max(own.get())));
    });
}

/// Bytes in use and the most that were; a request that would exceed the cap ends the program.
///
/// Put one into a test program with `#[global_allocator]`. The cap is on the whole process; what a reader takes is counted
/// on its own thread, so that tests beside it do not matter. Readers start no threads.
#[derive(Debug)]
pub struct CountingAllocator {
    live: AtomicUsize,
    /// The input being read, to be kept when memory runs out: there is no way back from that.
    input: AtomicPtr<u8>,
    input_len: AtomicUsize,
}

/// Memory beyond which the program is ended rather than the machine endangered: 4 GiB.
const CAP: usize = 4 << 30;

impl CountingAllocator {
    /// Nothing counted yet.
    pub const fn new() -> Self {
        Self {
            live: AtomicUsize::new(0),
            input: AtomicPtr::new(std::ptr::null_mut()),
            input_len: AtomicUsize::new(0),
        }
    }

    /// Runs `work` on `input` and says how many bytes it had in use at most, on top of what was in use before.
    pub fn measure<T>(&self, input: &[u8], work: impl FnOnce() -> T) -> (T, usize) {
        self.input.store(input.as_ptr().cast_mut(), Relaxed);
        self.input_len.store(input.len(), Relaxed);
        let before = OWN.get();
        OWN_PEAK.set(before);
        let result = work();
        let peak = OWN_PEAK.get() - before;
        self.input_len.store(0, Relaxed);
        (result, usize::try_from(peak).unwrap_or(0))
    }

    fn add(&self, bytes: usize) {
        count(bytes as isize);
        let live = self.live.fetch_add(bytes, Relaxed) + bytes;
        if live > CAP {
            self.give_up(live);
        }
    }

    fn subtract(&self, bytes: usize) {
        count(-(bytes as isize));
        self.live.fetch_sub(bytes, Relaxed);
    }

    #[cold]
    fn give_up(&self, live: usize) -> ! {
        let len = self.input_len.swap(0, Relaxed);
        // SAFETY: `measure` holds the slice while its length is not zero.
        let input = unsafe { std::slice::from_raw_parts(self.input.load(Relaxed).cast_const(), len) };
        self.live.store(0, Relaxed);
        let place = crate::finds_folder().join("out-of-memory.bin");
        let kept = std::fs::write(&place, input).is_ok();
        let _ = std::io::Write::write_all(
            &mut std::io::stderr(),
            format!("a reader took {live} bytes; its input is {} ({kept})\n", place.display()).as_bytes(),
        );
        std::process::abort()
    }
}

impl Default for CountingAllocator {
    fn default() -> Self {
        Self::new()
    }
}

// SAFETY: everything is handed on to the system's allocator unchanged.
unsafe impl GlobalAlloc for CountingAllocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        self.add(layout.size());
        // SAFETY: the caller's promises are the system's demands.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        self.add(layout.size());
        // SAFETY: as above.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        self.subtract(layout.size());
        // SAFETY: as above.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // Old and new may both be there while bytes move.
        self.add(size);
        self.subtract(layout.size());
        // SAFETY: as above.
        unsafe { System.realloc(pointer, layout, size) }
    }
}
