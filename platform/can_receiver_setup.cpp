#include "platform/can_receiver.hpp"

namespace landfix::platform {

CanReceiver::~CanReceiver() = default;

}  // namespace landfix::platform
