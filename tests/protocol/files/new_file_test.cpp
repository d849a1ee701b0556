// Files in the making: nothing is seen of them until they are whole, and no link leads their bytes elsewhere.
#include "protocol/files/new_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>

#include "protocol/core/error.hpp"
#include "protocol/files/hdf5_file.hpp"
#include "protocol/files/text_file.hpp"
#include "tests/nodes/temporary_folder.hpp"

namespace furrow {
namespace {

namespace fs = std::filesystem;

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
  return names;
}

TEST(NewFile, stands_under_an_unknown_name_until_it_is_published) {
  const testing::TemporaryFolder folder;
  const fs::path file = folder.path() / "a.txt";
  std::string unknown;
  {
    NewFile first(file), second(file);
    first.write("fir");
    first.write("st");
    second.write("second");
    const std::set<std::string> names = names_in(folder.path());
    ASSERT_EQ(names.size(), 2U) << "of the same file, each has a name of its own";
    for (const std::string& name : names) EXPECT_EQ(name_in_the_making(name), "a.txt") << name;
    first.publish();
    EXPECT_EQ(read_whole_file(file), "first");
  }
  EXPECT_EQ(names_in(folder.path()), std::set<std::string>{"a.txt"}) << "what was not published is gone";
}

TEST(NewFile, no_link_that_stands_there_is_followed) {
  const testing::TemporaryFolder folder;
  const fs::path victim = folder.path() / "victim";
  std::ofstream(victim) << "mine";
  for (const char* name : {"a.json", ".a.json.part", "a.h5", ".a.h5.part"})
    fs::create_symlink(victim, folder.path() / name);
  write_whole_file(folder.path() / "a.json", "{}");
  Hdf5Writer h5(folder.path() / "a.h5");
  h5.put("x", std::vector<double>{1.0}, {1});
  h5.finish();
  EXPECT_EQ(read_whole_file(victim), "mine");
  EXPECT_FALSE(fs::is_symlink(folder.path() / "a.json"));
  EXPECT_FALSE(fs::is_symlink(folder.path() / "a.h5"));
  EXPECT_EQ(Hdf5Reader(folder.path() / "a.h5").get<double>("x"), std::vector<double>{1.0});
}

TEST(NewFile, an_hdf5_file_reaches_its_file_though_the_unknown_name_was_taken_by_a_link) {
  const testing::TemporaryFolder folder;
  const fs::path victim = folder.path() / "victim";
  std::ofstream(victim) << "mine";
  NewFile file(folder.path() / "a.bin");
  const fs::path part = folder.path() / *names_in(folder.path()).begin();
  fs::remove(part);
  fs::create_symlink(victim, part);
  std::ofstream(file.way()) << "others";
  EXPECT_EQ(read_whole_file(victim), "mine");
}

TEST(NewFile, only_names_of_its_form_are_in_the_making) {
  EXPECT_EQ(name_in_the_making(".a.h5.0123456789abcdef.part"), "a.h5");
  EXPECT_EQ(name_in_the_making("..furrow-run.0123456789abcdef.part"), ".furrow-run");
  for (const char* name :
       {"a.h5", ".a.h5.part", ".a.h5.0123456789abcde.part", ".a.h5.0123456789abcdeF.part",
        "a.h5.0123456789abcdef.part", ".0123456789abcdef.part", "..0123456789abcdef.part", ".part", ""})
    EXPECT_EQ(name_in_the_making(name), "") << name;
}

TEST(NewFile, a_folder_that_is_not_there_is_told_by_the_files_name) {
  try {
    NewFile("/proc/nowhere/a.txt");
    FAIL() << "was created";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::io);
    EXPECT_EQ(std::string(error.what()), "/proc/nowhere/a.txt: cannot create: No such file or directory");
  }
}

}  // namespace
}  // namespace furrow
