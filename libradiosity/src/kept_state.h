#pragma once

#include "row_state.h"

namespace atrium::radiosity {

/// Writes down what is known now, once, if SolveOptions::keep asks for it.
template <int N>
void keep(RowState<N>& s);

/// Says what is being done. \return  true if the work is to stop here; then what is known now is
/// kept for later.
template <int N>
bool paused(RowState<N>& s, Stage stage);

/// Reads what keep() wrote.
/// \param sides  of the state's mesh. \param other_lights  then other sides may be active;
/// smoothings and the table of lights are made anew.
/// \throws Error  if it is damaged.
template <int N>
void read_state(RowState<N>& s, scene::ArchiveReader& from, std::size_t sides, bool other_lights);

}  // namespace atrium::radiosity
