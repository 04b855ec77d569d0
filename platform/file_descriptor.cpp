#include "platform/file_descriptor.hpp"

#include <unistd.h>

namespace landfix::platform {

void FileDescriptor::close() noexcept {
  if (number_ >= 0) ::close(number_);
  number_ = -1;
}

}  // namespace landfix::platform
