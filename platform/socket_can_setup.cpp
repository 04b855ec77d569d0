#include "platform/socket_can.hpp"

namespace landfix::platform {

SocketCan::~SocketCan() = default;

}  // namespace landfix::platform
