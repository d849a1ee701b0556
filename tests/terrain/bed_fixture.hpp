// Beds of a few hundred grains; each test has its own cache.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "terrain/dem/dem_options.hpp"
#include "tests/temporary_folder.hpp"

namespace furrow::terrain::dem {

class SmallBeds : public ::testing::Test {
 protected:
  SmallBeds() {
    options_.radius = 0.01;
    options_.layers = 4;
    options_.length = 0.3;
    options_.width = 0.2;
    options_.step = 6e-5;
  }
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder() / name) << text;
    return (folder() / name).string();
  }
  const std::filesystem::path& folder() const { return cache_.path(); }

  DemOptions options_;

 private:
  testing::OwnCache cache_;
};

}  // namespace furrow::terrain::dem
