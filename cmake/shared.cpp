// A shared library needs a source of its own; all there is comes from the static ones.
