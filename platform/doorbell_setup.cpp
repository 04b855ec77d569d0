#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

#include <sys/eventfd.h>

#include "platform/doorbell.hpp"

namespace landfix::platform {

Doorbell::Doorbell() : event_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  if (!event_.is_open())
    throw std::runtime_error(std::string("no event descriptor: ") + std::strerror(errno));
}

}  // namespace landfix::platform
