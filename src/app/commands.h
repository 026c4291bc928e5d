#pragma once

#include "app/options.h"

namespace carom {

/// The exit codes that scripts rely on.
enum class ExitCode { holds = 0, violated = 1, bad_input = 2, machine_failed = 3 };

/// carom list
ExitCode list_command(const Options& options);

/// carom run and carom check: load, run, compare, write what was asked for, print.
/// @throws InputError before anything is run or written; MachineError.
ExitCode compare_command(const Options& options);

/// carom law: what laws from files keep and break, beside the right one; without a law, those that there are.
/// @throws InputError, MachineError
ExitCode law_command(const Options& options);

/// carom explain: switch the engine's settings one by one, print which explains its divergence. Exit code
/// `violated` where the run that is to be explained does not end well.
/// @throws InputError before anything is run; MachineError.
ExitCode explain_command(const Options& options);

/// carom study: what accuracy costs in time. A run that does not end well is a row of it and no violation.
/// @throws InputError before anything is run or written; MachineError.
ExitCode study_command(const Options& options);

/// carom lab: serves the lab's page on this machine until a signal ends it. @throws MachineError
ExitCode lab_command(const Options& options);

}  // namespace carom
