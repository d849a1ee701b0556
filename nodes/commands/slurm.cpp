// `furrow ranks --slurm`: a batch script that runs a scenario under Slurm, however long it takes. Slurm signals
// the job some minutes before its time is over. The run then saves its state and ends with 75, and the job is queued
// again and continues (scripts/cluster/README.md).
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <regex>

#include <fmt/format.h>

#include "nodes/commands/slurm.hpp"
#include "nodes/commands/typed.hpp"
#include "nodes/launch/thread_setup.hpp"
#include "nodes/scenario/rank_table.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/host.hpp"

namespace furrow::commands {
namespace {

constexpr int kWarning = 360;            // s before a job's end when Slurm signals it: a checkpoint and Slurm's delays
constexpr int kLeastWork = 120;          // s of work before that signal, at least
constexpr int kMostRestarts = 3;         // of a job that never reached its first checkpoint
constexpr double kMemoryMargin = 1.3;    // of the estimate
constexpr double kMemoryOfRank = 256e6;  // bytes in addition, for libraries and files
constexpr double kMebibyte = 1048576.0;

Error wrong(const std::string& option, const std::string& what) { return input_error("command line", option, what); }

void check_word(const std::string& option, const std::string& value) {
  static const std::regex kWord("[A-Za-z0-9_.,:@+-]+");
  if (!value.empty() && !std::regex_match(value, kWord))
    throw wrong(option, "is '" + value + "', expected a name as Slurm has them");
}

/// Converts a time as Slurm reads it to s: minutes[:seconds], hours:minutes:seconds or days-hours[:minutes[:seconds]];
/// none: it is not a time.
std::optional<double> seconds_of(const std::string& time) {
  static const std::regex kShort("([0-9]{1,7})(?::([0-5]?[0-9]))?");
  static const std::regex kHours("([0-9]{1,5}):([0-5]?[0-9]):([0-5]?[0-9])");
  static const std::regex kDays("([0-9]{1,4})-([01]?[0-9]|2[0-3])(?::([0-5]?[0-9]))?(?::([0-5]?[0-9]))?");
  std::smatch found;
  const auto part = [&found](std::size_t k) { return found[k].matched ? std::stod(found[k].str()) : 0.0; };
  if (std::regex_match(time, found, kShort)) return 60.0 * part(1) + part(2);
  if (std::regex_match(time, found, kHours)) return 3600.0 * part(1) + 60.0 * part(2) + part(3);
  if (std::regex_match(time, found, kDays)) return 86400.0 * part(1) + 3600.0 * part(2) + 60.0 * part(3) + part(4);
  return {};
}

void check_time(const std::string& time) {
  if (time.empty()) return;
  const std::optional<double> seconds = seconds_of(time);
  if (!seconds) throw wrong("--time", "is '" + time + "', expected minutes, hh:mm:ss or days-hh:mm:ss");
  if (*seconds < kWarning + kLeastWork)
    throw wrong("--time", fmt::format("is '{}', expected {} minutes or more: the run saves its state {} minutes before",
                                      time, (kWarning + kLeastWork) / 60, kWarning / 60));
}

/// Distribution of the ranks on the nodes: `each` on every node, in their order, fewer on the last.
struct Layout {
  int ranks = 0, nodes = 1, each = 0;
};

/// Tasks as Slurm counts them: on one node, furrow starts its ranks itself.
int tasks_of_node(const Layout& layout) { return layout.nodes == 1 ? 1 : layout.each; }

Layout layout_of(const scenario::Scenario& scenario, const SlurmArguments& job) {
  const int ranks = static_cast<int>(scenario::rank_table(scenario).size());
  if (job.nodes < 1 || job.nodes > ranks)
    throw wrong("--nodes", fmt::format("is {}, expected 1 to {}: this scenario has {} ranks", job.nodes, ranks, ranks));
  const Layout layout{ranks, job.nodes, (ranks + job.nodes - 1) / job.nodes};
  if (const int used = (ranks + layout.each - 1) / layout.each; used < job.nodes)
    throw wrong("--nodes", fmt::format("is {}, expected {}: {} ranks, {} on each node, leave the others empty",
                                       job.nodes, used, ranks, layout.each));
  const int least = std::max(1, job.nodes == 1 ? ranks - 1 : layout.each);  // the rig hardly computes
  if (job.cores_per_node != 0 && job.cores_per_node < least)
    throw wrong("--cores-per-node", fmt::format("is {}, expected {} or more: {} ranks on each node", job.cores_per_node,
                                                least, layout.each));
  if (const int tasks = tasks_of_node(layout); job.cores_per_node % tasks != 0)
    throw wrong("--cores-per-node", fmt::format("is {}, expected {} or another multiple of the {} ranks on each node: "
                                                "Slurm gives each of them as many cores",
                                                job.cores_per_node, job.cores_per_node / tasks * tasks, tasks));
  return layout;
}

/// The ranks of one node, as they will see it.
launch::HostView host_view(const Layout& layout, int node, int tires, int cores) {
  launch::HostView host;
  host.machine_cores = cores;
  std::vector<int> numbers(static_cast<std::size_t>(cores));
  std::iota(numbers.begin(), numbers.end(), 0);
  for (int rank = node * layout.each; rank < std::min(layout.ranks, (node + 1) * layout.each); ++rank)
    host.nodes.push_back({address_of(rank, tires), numbers, false});
  return host;
}

/// "#   2     0      7  terrain  grains, …", one line per rank.
std::string rank_lines(const scenario::Scenario& scenario, const SlurmArguments& job, const Layout& layout) {
  std::string text = "# rank  node  threads  what\n";
  const int tires = static_cast<int>(scenario.tires.size());
  for (const scenario::RankEntry& entry : scenario::rank_table(scenario)) {
    const int node = entry.rank / layout.each;
    std::string threads = "-";
    if (job.cores_per_node > 0) {
      launch::HostView host = host_view(layout, node, tires, job.cores_per_node);
      host.grains = scenario.terrain->estimate(scenario.terrain_context()).grains;
      const auto place = static_cast<std::size_t>(entry.rank - node * layout.each);
      threads = std::to_string(launch::plan_threads(host, place, scenario.run.threads).threads);
    }
    text += fmt::format("# {:>4}  {:>4}  {:>7}  {:<9} {}\n", entry.rank, node, threads, entry.node, entry.does);
  }
  return text;
}

std::string directives(const scenario::Scenario& scenario, const SlurmArguments& job, const Layout& layout) {
  std::string text;
  const auto add = [&text](const std::string& option) { text += "#SBATCH " + option + "\n"; };
  std::string name = "furrow-" + scenario.name;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return c <= 0x20 || c == 0x7F; }, '_');
  add("--job-name=" + scenario::shell_quoted(name));
  add(fmt::format("--nodes={}", layout.nodes));
  if (job.cores_per_node == 0) {
    add(fmt::format("--ntasks-per-node={}", layout.each));
    add("--exclusive");
    add("--mem=0");
  } else {
    const int tasks = tasks_of_node(layout);
    const double memory = kMemoryMargin * scenario.memory.all / layout.nodes + kMemoryOfRank * layout.each;
    add(fmt::format("--ntasks-per-node={}", tasks));
    add(fmt::format("--cpus-per-task={}", job.cores_per_node / tasks));
    add(fmt::format("--mem={:.0f}M", std::ceil(memory / kMebibyte)));
  }
  if (!job.partition.empty()) add("--partition=" + job.partition);
  if (!job.account.empty()) add("--account=" + job.account);
  if (!job.time.empty()) add("--time=" + job.time);
  add(fmt::format("--signal=B:USR1@{}", kWarning));
  add("--requeue");
  add("--open-mode=append");
  return text;
}

/// Path of this program; in an installed tree, the command that chooses the build for the job's processor.
std::filesystem::path program_for_all_nodes() {
  std::error_code error;
  const std::filesystem::path own = this_program();
  const std::filesystem::path builds = own.parent_path().parent_path();  // libexec/furrow/<level>/furrow
  const std::filesystem::path command = builds.parent_path().parent_path() / "bin" / "furrow";
  const bool installed = builds.filename() == "furrow" && builds.parent_path().filename() == "libexec";
  return installed && std::filesystem::is_regular_file(command, error) ? command : own;
}

/// The common part of every script: how a job begins, and how it is queued again.
constexpr const char* kBody = R"(
start=("$program" run "${{settings[@]}}" --out="$run" -- "$scenario")
if [[ ${{SLURM_RESTART_COUNT:-0}} -gt 0 ]]; then
  [[ ! -e $run/summary.json ]] || exit 0  # done
  saved=("$run"/checkpoints/[0-9]*)  # the pattern itself where nothing fits
  if [[ -e ${{saved[0]}} ]]; then
    start=("$program" resume -- "$run")
  elif [[ $SLURM_RESTART_COUNT -ge {0} ]]; then
    echo "furrow: error: ended {0} times before the first checkpoint, expected a job with more --time" >&2
    exit 2
  else
    start=("$program" run --overwrite "${{settings[@]}}" --out="$run" -- "$scenario")
  fi
fi

# On the signal furrow saves its state and ends with 75. Either Slurm then queues the job again …
if scontrol show config 2>/dev/null | grep -Eq '^RequeueExit *= *([0-9]+,)*75(,|$)'; then
  exec "${{start[@]}}"
fi
# … or this script asks for it.
"${{start[@]}}" &
furrow=$! again=
trap 'asked=1 again=1; kill -USR1 "$furrow"' USR1
trap 'asked=1; kill -TERM "$furrow"' TERM
while asked=; wait "$furrow"; code=$?; [[ $asked ]]; do :; done
if [[ $code -eq 75 && $again ]]; then scontrol requeue "$SLURM_JOB_ID"; fi
exit "$code"
)";

}  // namespace

CLI::Option* add_slurm_options(CLI::App& command, SlurmArguments& job) {
  CLI::Option* slurm = command.add_flag("--slurm")->description(
      "Print a batch script for sbatch. It saves the run before its time is over, and continues when it is queued "
      "again.");
  const auto of_slurm = [&](CLI::Option* option) { option->needs(slurm); };
  of_slurm(
      command.add_option("--nodes", job.nodes, "Use this number of nodes; the ranks are spread over them in order.")
          ->capture_default_str());
  of_slurm(command
               .add_option("--cores-per-node", job.cores_per_node,
                           "Use this number of cores on each node (default: all of them).")
               ->check(above_zero()));
  of_slurm(command.add_option("--partition", job.partition, "Submit to this partition (default: the cluster's)."));
  of_slurm(command.add_option("--time", job.time,
                              "Limit one start of the job to this time, in minutes, as hh:mm:ss or as days-hh:mm:ss. A "
                              "longer run takes several starts (default: the partition's limit)."));
  of_slurm(command.add_option("--account", job.account, "Charge the job to this account (default: your own)."));
  of_slurm(command.add_option(
      "--out", job.out,
      "Write the results to this new folder (default: results/<scenario>-job<number> where you submit)."));
  return slurm;
}

std::string slurm_script(const scenario::Scenario& scenario, const SlurmArguments& job, const Settings& settings) {
  check_word("--partition", job.partition);
  check_word("--account", job.account);
  check_time(job.time);
  const Layout layout = layout_of(scenario, job);
  const std::filesystem::path program = program_for_all_nodes();
  const auto full = [](const std::filesystem::path& path) {
    return scenario::shell_quoted(std::filesystem::absolute(path).lexically_normal().string());
  };
  std::string list;
  for (const auto& [key, value] : settings)
    list += (list.empty() ? "" : " ") + scenario::shell_quoted("--set=" + key + "=" + value);

  std::string text = "#!/bin/bash\n";
  text += directives(scenario, job, layout);
  text += fmt::format("# {} ranks on {} node{} of {}; each binds itself to its share of the cores.\n", layout.ranks,
                      layout.nodes, layout.nodes > 1 ? "s" : "",
                      job.cores_per_node > 0 ? fmt::format("{} cores", job.cores_per_node) : "any number of cores");
  text += rank_lines(scenario, job, layout) + "\nset -u\n";
  text += "program=" + full(program) + "\n";
  text += "scenario=" + full(scenario.file) + "\n";
  text += "settings=(" + list + ")\n";
  // The results' folder is the same each time this job starts.
  text += "run=" +
          (job.out.empty() ? "results/" + scenario::shell_quoted(scenario.name) + "-job$SLURM_JOB_ID" : full(job.out)) +
          "\n";
  return text + fmt::format(kBody, kMostRestarts);
}

}  // namespace furrow::commands
