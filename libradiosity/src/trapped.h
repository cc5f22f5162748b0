#pragma once

#include "rows.h"

namespace atrium::radiosity {

/// By side: lanes (as bits) whose light never gets out, as far as the rows tell: no chain of
/// entries from this side meets a loss. Empty if there is no such side, as in every scene that
/// absorbs everywhere.
template <int N>
[[nodiscard]] std::vector<std::uint8_t> find_trapped(const Problem<N>& problem,
                                                     const Rows<N>& rows);

/// \throws Error  if one of the trapped groups is an enclosure: no other side sees it, at least 500
///                rays stay in it, and source or constant light it.
template <int N>
void refuse_enclosures(const Problem<N>& problem, const Rows<N>& rows,
                       const std::vector<std::uint8_t>& trapped, const SideValues<N>& source,
                       const SideValues<N>& constant);

}  // namespace atrium::radiosity
