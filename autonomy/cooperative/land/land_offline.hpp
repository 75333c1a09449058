// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "autonomy/cooperative/driver/offline.hpp"
#include "autonomy/cooperative/land/land_record.hpp"

namespace navigation {

/// Runs an algorithm for all land vehicles of a record, with an estimate each `period_us`; OfflineRun::ranges are the
/// relative measurements, and `frames_said` the payloads.
///
/// The vehicles start at their places in the world.  Whatever a vehicle sends by radio becomes a frame with the payload
/// of the algorithm and the velocity of the sender; the next relative measurement of the sender within 3 s has this
/// payload, and is corrected by the distance that the sender traveled since.  Further relative measurements have no
/// payload.  In a record without radio messages every relative measurement has a payload of that instant.  A
/// TeamEstimator needs no payloads, and uses every relative measurement.
///
/// Throws std::invalid_argument when the algorithm cannot work.
OfflineRun run_on_land(const LandRecord& record, const Algorithm& algorithm, const NavOptions& options,
                       std::int64_t period_us);

}  // namespace navigation
