// The command's answer where PCL is not installed, tested also where it is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/command.hpp"
#include "tools/pcl_rival.hpp"

namespace landfix::tools {
namespace {

TEST(PclRivalMissing, SaysWhichPackageToInstall) {
  EXPECT_FALSE(PclRival::available());
  try {
    const PclRival rival(1.0, 2.0);
    FAIL() << "made a rival of nothing";
  } catch (const UsageError& error) {  // exit 2
    EXPECT_THAT(error.what(), testing::HasSubstr("apt-get install libpcl-dev"));
  }
}

}  // namespace
}  // namespace landfix::tools
