#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace carom {

/// What the command line says.
struct Options {
  std::string command;  ///< "list", "run", "check", "study", "explain", "law", "lab" or "help"
  std::string topic;    ///< of list and help

  std::vector<std::string> scenes;
  std::vector<std::string> engines;       ///< as written: "name" or "name@profile"
  std::vector<std::string> laws;          ///< files, or names of laws that come with Carom
  std::string metric;                     ///< of explain; empty: the one that tells the most
  std::vector<std::string> engines_from;  ///< folders with further engine modules
  std::optional<double> step_s;
  std::optional<std::uint64_t> seed;

  std::string json_file;
  std::string csv_folder;
  std::string report_folder;
  std::string junit_file;
  std::string summary_file;
  std::string baseline_file;        ///< to hold the results against
  std::string write_baseline_file;  ///< to write the results' values to
  std::optional<double> baseline_factor;
  bool all_balls = false;

  std::string csv_file;     ///< of a study
  std::string resume_file;  ///< that a study is kept in while it goes, and taken up from
  std::string study_file;   ///< a study that the page shows, too
  int repeats = 5;          ///< timed runs of each setting
  double study_timeout_s = 2.0;
  double budget_s = 30.0;  ///< CPU time of a study for each scene

  int port = 8010;  ///< of the lab; 0: any that is free

  int parallel = 1;
  std::size_t threads = 1;  ///< for a run of carom
  double timeout_s = 120.0;
  double memory_mib = 4096.0;
  bool quiet = false;
  bool color = false;
};

/// The outcome of reading the command line: options, or what to print and the exit code to end with.
struct Parsed {
  Options options;
  std::optional<int> exit_code;
};

/// Reads the command line; prints help, the version, or what is wrong with it.
Parsed parse_options(int argc, char** argv);

}  // namespace carom
