// A saved state comes back bit for bit, or not at all.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include "protocol/core/hash.hpp"
#include "protocol/files/archive_file.hpp"
#include "protocol/files/hdf5_file.hpp"
#include "tests/nodes/temporary_folder.hpp"

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

constexpr ArchiveKind kBed{"bed", "a bed", 4, 4, ""};

std::string error_of(const std::filesystem::path& file, const ArchiveKind& kind = kSavedState) {
  try {
    read_archive(file, kind);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::io);
    return error.what();
  }
  return "";
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
  for (const auto& [version, words] :
       {std::pair(3, "older than this program's 4"), {5, "newer than this program's 4"}}) {
    other.version = version;
    write_archive(file, example(), other);
    EXPECT_NE(error_of(file, kBed).find(words), std::string::npos) << error_of(file, kBed);
  }
  EXPECT_NE(error_of(file).find("bed.h5: is not a saved state"), std::string::npos);
}

/// As versions before kind_version wrote beds: the arrays at the root, beside the datasets format_version and checksum.
TEST(ArchiveFile, beds_of_earlier_versions_are_read) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "old.h5";
  const Archive archive = example();
  Hash hash;
  for (const auto& [name, array] : archive.arrays()) {
    hash.add(name);
    std::visit([&](const auto& values) { hash.add(values.data(), values.size() * sizeof values[0]); }, array);
  }
  const auto write = [&](std::int64_t version, std::uint64_t checksum) {
    Hdf5Writer out(file);
    out.put("format_version", std::vector<std::int64_t>{version}, {1});
    out.put("checksum", std::vector<std::uint64_t>{checksum}, {1});
    for (const auto& [stored, values] : archive.arrays())
      std::visit([&, &name = stored](const auto& v) { out.put(name, std::span(v), {v.size()}); }, values);
    out.finish();
  };
  write(4, hash.value());
  expect_same_bits(archive, read_archive(file, kBed));
  EXPECT_TRUE(may_be_archive(file, kBed));
  write(4, hash.value() + 1);
  EXPECT_NE(error_of(file, kBed).find("checksum"), std::string::npos);
  write(3, hash.value());
  EXPECT_NE(error_of(file, kBed).find("is older than"), std::string::npos);
}

/// As versions before kind_version wrote saved states; their checksum covered types and lengths as well.
TEST(ArchiveFile, saved_states_of_earlier_versions_are_read) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "old.h5";
  Hdf5Writer out(file);
  out.attribute("kind", std::string("state"));
  out.attribute("arrays", std::int64_t{1});
  out.attribute("checksum", std::string("0123456789abcdef"));
  out.put("state/grains:x", std::vector<double>{1.0, 2.0}, {2});
  out.finish();
  EXPECT_EQ(read_archive(file).get<double>("grains/x"), (std::vector<double>{1.0, 2.0}));
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
    EXPECT_NE(error_of(cut).find("cut.h5"), std::string::npos) << "share kept " << share;
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
  EXPECT_NE(error_of(file).find("checksum"), std::string::npos);
}

TEST(ArchiveFile, missing_files_and_other_kinds_of_file_are_refused) {
  const testing::TemporaryFolder folder;
  EXPECT_NE(error_of(folder.path() / "nothing.h5").find("does not exist"), std::string::npos);
  Hdf5Writer other(folder.path() / "frame.h5");
  other.attribute("time_s", 1.0);
  other.finish();
  EXPECT_NE(error_of(folder.path() / "frame.h5").find("not a saved state"), std::string::npos);
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
  EXPECT_NE(error_of(file).find("format_version 99"), std::string::npos);
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
  try {
    Hdf5Writer file("/proc/nowhere/results.h5");
    FAIL() << "was created";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::io);
    EXPECT_NE(std::string(error.what()).find("/proc/nowhere/results.h5"), std::string::npos);
  }
}

}  // namespace
}  // namespace furrow
