"""tools/bench bop: sets as the BOP challenge publishes them, taught, found, measured, beside rivals."""
