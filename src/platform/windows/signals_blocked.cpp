#include "platform/signals_blocked.h"

namespace fppg
{

SignalsBlocked::SignalsBlocked() : before_{} {}
SignalsBlocked::~SignalsBlocked() = default;

} // namespace fppg
