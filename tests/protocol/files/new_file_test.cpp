// Files while they are written: they are invisible until they are complete, and no link redirects their bytes.
#include "protocol/files/new_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <csignal>
#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

#include <fstream>
#include <iterator>
#include <set>

#include "protocol/core/error.hpp"
#include "protocol/files/hdf5_file.hpp"
#include "protocol/files/text_file.hpp"
#include "tests/refusal.hpp"
#include "tests/temporary_folder.hpp"

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

/// Limits files to this number of bytes, as on a full disk, until space is made.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() { make_room(); }
  void make_room() { setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

/// HDF5 itself leaks the 1 kB in which it gathers the metadata of a file that it cannot write (1.10.8,
/// H5F__accum_write): memory allocated while this object lives is not our leak.
struct LeaksOfTheLibrary {
#ifdef __SANITIZE_ADDRESS__
  herr_t collected = H5garbage_collect();  // memory that it kept from before would count as this leak
  __lsan::ScopedDisabler disabler;
#endif
};

constexpr int kPuts = 8;

/// A file like a frame, of datasets around the sizes of the library's buffers. @param before is called before each
/// step.
template <class Before>
void write_file(const fs::path& file, const Before& before) {
  before(0);
  Hdf5Writer out(file);
  for (int k = 1; k < kPuts - 1; ++k) {
    before(k);
    out.put("group/set" + std::to_string(k), std::vector<double>(100 << k, 1.0 + k), {hsize_t{100} << k});
  }
  before(kPuts - 1);
  out.attribute("text", std::string(300, 't'));
  before(kPuts);
  out.finish();
}

TEST(NewFile, what_a_full_disk_did_not_take_is_never_published_although_it_has_room_again) {
  [[maybe_unused]] const LeaksOfTheLibrary leaks;
  const auto handled = std::signal(SIGXFSZ, SIG_IGN);
  const testing::TemporaryFolder folder;
  const fs::path good = folder.path() / "good.h5", file = folder.path() / "a.h5";
  write_file(good, [](int) {});
  const std::string whole = read_whole_file(good);
  ASSERT_GT(whole.size(), 70000U);
  int refused = 0;
  for (rlim_t bytes = 0; bytes < whole.size(); bytes += 3001)
    for (int room_at = 1; room_at <= kPuts; ++room_at) {
      FullDisk disk(bytes);
      try {
        write_file(file, [&](int step) {
          if (step == room_at) disk.make_room();
        });
      } catch (const Error& error) {
        disk.make_room();
        EXPECT_EQ(error.code(), ExitCode::io);
        EXPECT_EQ(names_in(folder.path()), std::set<std::string>{"good.h5"});
        ++refused;
        continue;
      }
      disk.make_room();
      EXPECT_TRUE(read_whole_file(file) == whole) << bytes << " bytes, room at step " << room_at;
      fs::remove(file);
    }
  EXPECT_GT(refused, 20);
  std::signal(SIGXFSZ, handled);
}

TEST(NewFile, only_names_of_its_form_are_in_the_making) {
  EXPECT_EQ(name_in_the_making(".a.h5.0123456789abcdef.part"), "a.h5");
  EXPECT_EQ(name_in_the_making("..furrow-run.0123456789abcdef.part"), ".furrow-run");
  for (const char* name :
       {"a.h5", ".a.h5.part", ".a.h5.0123456789abcde.part", ".a.h5.0123456789abcdeF.part", "a.h5.0123456789abcdef.part",
        ".0123456789abcdef.part", "..0123456789abcdef.part", ".part", ""})
    EXPECT_EQ(name_in_the_making(name), "") << name;
}

TEST(NewFile, a_folder_that_is_not_there_is_told_by_the_files_name) {
  EXPECT_EQ(refusal(ExitCode::io, [&] { NewFile("/proc/nowhere/a.txt"); }),
            "/proc/nowhere/a.txt: cannot create: No such file or directory");
}

}  // namespace
}  // namespace furrow
