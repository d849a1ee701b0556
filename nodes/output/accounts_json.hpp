// The accounts of a run in its summary.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "nodes/output/accounts.hpp"

namespace furrow::output {

/// `accounts` of summary.json: momentum and energy since the start of the run, and the mean powers from `from` on.
/// @param table of accounts; its lines from `from` on give the powers
nlohmann::ordered_json accounts_json(const Accounts& accounts, const Table& table, double from);

}  // namespace furrow::output
