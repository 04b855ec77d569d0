#include "platform/mapped_file.hpp"

#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/test_data.hpp"

namespace landfix::platform {
namespace {

using testing::HasSubstr;

class MappedFileTest : public testing::Test {
 protected:
  void write(const std::string& text) const { std::ofstream(path_, std::ios::binary) << text; }
  [[nodiscard]] static std::string text_of(const MappedFile& file) {
    return {reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size()};
  }

  test::TemporaryDirectory directory_;
  std::filesystem::path path_ = directory_.path() / "file";
};

TEST_F(MappedFileTest, ShowsTheBytesAlsoAfterItsPagesWereGivenBack) {
  const std::string text(100'000, 'x');
  write(text);
  const MappedFile file(path_);
  EXPECT_TRUE(file.is_mapped());
  file.populate();
  EXPECT_EQ(text_of(file), text);
  file.drop_pages();
  EXPECT_EQ(text_of(file), text);
}

TEST_F(MappedFileTest, AnEmptyFileHasNoBytes) {
  write("");
  const MappedFile file(path_);
  file.populate();
  file.drop_pages();
  EXPECT_TRUE(file.bytes().empty());
}

TEST_F(MappedFileTest, AFileThatBecameShorterIsAnErrorAndNoSignal) {
  write(std::string(100'000, 'x'));
  const MappedFile file(path_);
  std::filesystem::resize_file(path_, 5000);
  try {
    file.populate();
    FAIL() << "it was taken";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("shorter than its 100000 bytes"));
  }
}

TEST_F(MappedFileTest, KeepsItsBytesWhenAnotherFileTakesItsName) {
  write("old");
  const MappedFile file(path_);
  const std::filesystem::path other = directory_.path() / "other";
  std::ofstream(other) << "new and longer";
  std::filesystem::rename(other, path_);
  EXPECT_EQ(text_of(file), "old");
}

TEST_F(MappedFileTest, SaysWhyAFileCannotBeOpened) {
  try {
    const MappedFile file(directory_.path() / "missing");
    FAIL() << "it was opened";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("missing: cannot open: No such file"));
  }
}

}  // namespace
}  // namespace landfix::platform
