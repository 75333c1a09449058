#pragma once

#include <memory>
#include <string>

#include "bridges/lcm/run_journal.hpp"
#include "bridges/lcm/sim_service.hpp"
#include "sim/run/lockstep.hpp"
#include "sim/run/run_control.hpp"
#include "tools/experiment/pacer.hpp"
#include "tools/experiment/progress.hpp"
#include "tools/experiment/results.hpp"
#include "tools/experiment/run_buses.hpp"
#include "tools/experiment/run_programs.hpp"
#include "tools/experiment/runner.hpp"
#include "tools/experiment/scoring.hpp"

namespace tools {

/// One run of a world: its parts, and the loop over steps.
class Run {
 public:
  /// Both must outlive this.  Throws ConfigError, BusError, std::runtime_error.
  Run(const sim::LoadedWorld& loaded, const RunOptions& options);
  /// From the first step to the summary.
  Summary go();

 private:
  void start_clients();
  void await(const std::vector<std::string>& clients);
  void loop();
  void step();
  void synchronize();
  /// Waits until the next step is due, answering requests meanwhile.
  void pace();
  void check_bus() const;
  void check_programs();
  bool wanted() const;
  std::string how_ended() const;
  std::uint64_t messages() const;
  void finish(Summary& summary);
  void add_figures(Summary& summary);
  void write_results(Summary& summary);

  const sim::LoadedWorld& loaded_;
  const RunOptions& options_;
  RunBuses buses_;
  sim::RunControl control_;
  sim::Lockstep lockstep_;
  bridges::RunJournal journal_;
  sim::World world_;
  bridges::SimService service_;
  Scoring scoring_;
  double duration_s_;
  Progress progress_;
  Pacer pacer_;
  RunPrograms programs_;
  bool alone_ = true;  ///< no other simulator was heard at the start
  std::unique_ptr<Results> results_;
};

}  // namespace tools
