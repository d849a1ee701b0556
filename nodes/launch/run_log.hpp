// Reads the log of a run in another process.
#pragma once

#include <filesystem>
#include <string>

namespace furrow::launch {

/// The reason why it ended: the signal that killed it, or the last error in its log. @param status of waitpid()
std::string last_error(const std::filesystem::path& log, int status);

/// Share of a run that is done, 0…1, by the last line of progress near the log's end; 0 if there is none.
double share_in_log(const std::filesystem::path& log);

}  // namespace furrow::launch
