#pragma once

namespace fppg
{

/// How long this machine takes for particles laid and relaxed on a ball, over the one that
/// src/batch/rates.h was measured on: processor time, the least of three runs of a quarter second.
double measure_speed();

} // namespace fppg
