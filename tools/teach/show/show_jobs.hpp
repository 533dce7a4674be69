#pragma once

#include "tools/teach/show/show_options.hpp"
#include "tools/teach/show/show_progress.hpp"

namespace houghstream::teach {

/// Teaches an object that is shown: follows it through the frames, fuses a model, judges it, writes what is to be kept,
/// and teaches it into the store. `second` (may be empty) gives the frames of a second take. `observer` may be null.
/// Returns the exit status: 0, or 3 where the model is poor and `accept_poor_model` is not set; the store is as it was
/// then. Throws InputError with one line for what cannot be shown at all.
int show_object(const ShowOptions& options, const ShownFrames& frames, const ShownFrames& second,
                ShowObserver* observer);

/// Teaches from the frames of `options.source` and `options.second`.
int show_sources(const ShowOptions& options, ShowObserver* observer);

}  // namespace houghstream::teach
