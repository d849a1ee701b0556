// A saved state comes back bit for bit, or not at all.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include <fmt/format.h>

#include "protocol/files/archive_file.hpp"
#include "protocol/files/hdf5_file.hpp"
#include "tests/refusal.hpp"
#include "tests/temporary_folder.hpp"

namespace furrow {
namespace {

using testing::TemporaryFolder;

Archive example() {
  Archive archive;
  archive.put("grains/x", std::vector<double>{0.1, -0.0, 5e-324, std::nan("7"), std::numeric_limits<double>::infinity(),
                                              1.0 / 3.0});
  archive.put("grains/list/start", std::vector<std::int64_t>{0, -1, std::numeric_limits<std::int64_t>::min()});
  archive.put("index", std::vector<std::int32_t>{1, 2, -3});
  archive.put("random", std::vector<std::uint64_t>{0, ~std::uint64_t{0}});
  archive.put("flags", std::vector<std::uint8_t>{0, 1, 255});
  archive.put("empty", std::vector<double>{});
  archive.put("time", 0.1 + 0.2);
  return archive;
}

void expect_same_bits(const Archive& a, const Archive& b) {
  ASSERT_EQ(a.arrays().size(), b.arrays().size());
  for (const auto& [name, array] : a.arrays()) {
    const auto found = b.arrays().find(name);
    ASSERT_NE(found, b.arrays().end()) << name;
    ASSERT_EQ(array.index(), found->second.index()) << name << " came back as another type";
    std::visit(
        [&, &name = name](const auto& values) {
          const auto& other = std::get<std::decay_t<decltype(values)>>(found->second);
          ASSERT_EQ(values.size(), other.size()) << name;
          if (values.empty()) return;  // memcmp wants pointers
          EXPECT_EQ(std::memcmp(values.data(), other.data(), values.size() * sizeof values[0]), 0) << name;
        },
        array);
  }
}

constexpr ArchiveKind kBed{"bed", "a bed", 4, ""};

std::string error_of(const std::filesystem::path& file, const ArchiveKind& kind = kSavedState) {
  return refusal(ExitCode::io, [&] { read_archive(file, kind); });
}

TEST(ArchiveFile, every_type_comes_back_bit_for_bit) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "rig.h5";
  write_archive(file, example());
  expect_same_bits(example(), read_archive(file));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1) << "a temporary file is left";
}

TEST(ArchiveFile, a_kind_without_a_group_keeps_the_names_as_they_are) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "bed.h5";
  write_archive(file, example(), kBed);
  expect_same_bits(example(), read_archive(file, kBed));
  EXPECT_TRUE(Hdf5Reader(file).has("grains/list/start"));
  EXPECT_TRUE(may_be_archive(file, kBed));
  EXPECT_FALSE(may_be_archive(file, kSavedState));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1) << "a temporary file is left";
}

TEST(ArchiveFile, other_kinds_and_versions_are_refused_by_name) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "bed.h5";
  ArchiveKind other = kBed;
  for (const std::int64_t version : {3, 5}) {
    other.version = version;
    write_archive(file, example(), other);
    EXPECT_TRUE(holds(error_of(file, kBed), fmt::format("of version {}, but this program reads version 4", version)));
  }
  EXPECT_TRUE(holds(error_of(file), "bed.h5: is not a saved state"));
}

TEST(ArchiveFile, an_empty_archive_comes_back_empty) {
  const testing::TemporaryFolder folder;
  write_archive(folder.path() / "none.h5", {});
  EXPECT_TRUE(read_archive(folder.path() / "none.h5").arrays().empty());
}

TEST(ArchiveFile, a_file_cut_short_at_any_length_is_refused_by_name) {
  const testing::TemporaryFolder folder;
  const auto whole = folder.path() / "whole.h5", cut = folder.path() / "cut.h5";
  write_archive(whole, example());
  const auto size = std::filesystem::file_size(whole);
  for (const double share : {0.0, 0.01, 0.3, 0.6, 0.9, 0.999}) {
    std::filesystem::copy_file(whole, cut, std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(cut, static_cast<std::uintmax_t>(share * static_cast<double>(size)));
    EXPECT_TRUE(holds(error_of(cut), "cut.h5")) << "share kept " << share;
  }
}

TEST(ArchiveFile, one_flipped_bit_in_the_numbers_is_noticed) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "state.h5";
  const double marker = 1234.56789012345;
  Archive archive;
  archive.put("values", std::vector<double>(100, marker));
  write_archive(file, archive);
  std::ifstream in(file, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), {});
  const auto at = bytes.find(std::string(reinterpret_cast<const char*>(&marker), sizeof marker));
  ASSERT_NE(at, std::string::npos);
  bytes[at] = static_cast<char>(bytes[at] ^ 1);
  std::ofstream(file, std::ios::binary) << bytes;
  EXPECT_TRUE(holds(error_of(file), "checksum"));
}

TEST(ArchiveFile, missing_files_and_other_kinds_of_file_are_refused) {
  const testing::TemporaryFolder folder;
  EXPECT_TRUE(holds(error_of(folder.path() / "nothing.h5"), "does not exist"));
  Hdf5Writer other(folder.path() / "frame.h5");
  other.attribute("time_s", 1.0);
  other.finish();
  EXPECT_TRUE(holds(error_of(folder.path() / "frame.h5"), "not a saved state"));
}

TEST(Hdf5File, a_newer_format_version_is_refused_by_name) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "newer.h5";
  const hid_t handle = H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t attribute = H5Acreate2(handle, "format_version", H5T_NATIVE_INT, space, H5P_DEFAULT, H5P_DEFAULT);
  const int version = 99;
  H5Awrite(attribute, H5T_NATIVE_INT, &version);
  H5Aclose(attribute);
  H5Sclose(space);
  H5Fclose(handle);
  EXPECT_TRUE(holds(error_of(file), "format_version 99"));
}

TEST(Hdf5File, without_finish_nothing_is_left) {
  const testing::TemporaryFolder folder;
  {
    Hdf5Writer file(folder.path() / "half.h5");
    file.put("x", std::vector<double>{1.0}, {1});
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Hdf5File, an_unwritable_folder_is_an_input_output_error_naming_the_file) {
  expect_refused(ExitCode::io, {"/proc/nowhere/results.h5"}, [&] { Hdf5Writer file("/proc/nowhere/results.h5"); });
}

}  // namespace
}  // namespace furrow
