#include "platform/bus_message.hpp"

#include <cerrno>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace landfix::platform {
namespace {

using testing::HasSubstr;

TEST(BusMessage, SaysWhatIsWrongAndWhatToDo) {
  const auto missing = [](int error) { return describe_bus("can0", BusState::missing, error); };
  EXPECT_THAT(missing(ENODEV), HasSubstr("can0: no such interface"));
  EXPECT_THAT(missing(ENXIO), HasSubstr("can0: no such interface"));
  EXPECT_THAT(missing(EAFNOSUPPORT), HasSubstr("this kernel has no CAN"));
  EXPECT_THAT(missing(EMSGSIZE), HasSubstr("ip link set can0 mtu 72"));
  EXPECT_EQ(missing(EPERM), "can0: no socket for it: Operation not permitted");
  EXPECT_EQ(describe_bus("can0", BusState::down, ENETDOWN), "can0: down; ip link set can0 up");
  EXPECT_THAT(describe_bus("can0", BusState::bus_off, 0), HasSubstr("restart-ms"));
  EXPECT_THAT(describe_bus("can0", BusState::error_passive, 0), HasSubstr("wiring"));
  EXPECT_EQ(describe_bus("can0", BusState::up, 0), "can0: up");
}

}  // namespace
}  // namespace landfix::platform
