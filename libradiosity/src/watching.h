#pragma once

#include "row_state.h"

namespace atrium::radiosity {

/// For who watches: light straight from the lights, the rest by and large.
template <int N>
void show_direct(RowState<N>& s);

enum class Bounces { Ambient, Rows };

/// For who watches, before anything was gathered: what the lights' samples say, and what follows
/// by the rows or, before there are any, by and large.
template <int N>
void show_bounces(const RowState<N>& s, Bounces known);

}  // namespace atrium::radiosity
