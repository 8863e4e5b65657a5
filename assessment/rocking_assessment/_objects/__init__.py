"""Assessment of objects at a site. `columns` declares inputs and outputs; `assess` begins with `objects` and `site`."""
