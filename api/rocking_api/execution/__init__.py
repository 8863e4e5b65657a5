"""Work outside the event loop: thread pool, limits, cancellation, batching."""
