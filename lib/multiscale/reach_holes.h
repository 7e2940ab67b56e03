// SPDX-License-Identifier: BSD-3-Clause
// Leads a cut to the holes that would stay whole on one of its sides.
#pragma once
#include <vector>

#include "lib/core/connectivity.h"
#include "lib/multiscale/filled_disk.h"

namespace meshpipe {

/// Changes the field (per vertex of the part) so that its zero level reaches every hole that lies in one side
/// as a whole, by a strip one vertex wide along a shortest path over edges; only where that cuts the side
/// open and does no more.
void reach_holes(const FilledDisk& disk, const Connectivity& part, std::vector<double>& field);

}  // namespace meshpipe
