#pragma once

namespace atrium::bench {

// Each registers the benchmarks of one hot path, named kind/what; items are rays, look-ups, samples
// or entries.
void register_rays();
void register_look_ups();
void register_lights();
void register_rows();

}  // namespace atrium::bench
