// Slurm as a cluster has it, small: munge, a controller and two nodes on this machine, everything in a temporary folder
// and in the network namespace of the one who makes it. Needs root, as slurmd does.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "system/lcm/background_process.h"
#include "system/lcm/own_network.h"
#include "system/program.h"

namespace edgeslam {

constexpr double slurm_patience_s = 240;  // a loaded machine

// Empty, or why there can be no cluster here. Enters a network of its own.
inline std::string slurmCannotRun() {
  if (geteuid() != 0) return "slurmd needs root";
  for (const std::string program : {"slurmctld", "slurmd", "munged", "sbatch"}) {
    if (!runsWell("command -v " + program)) return program + " is not installed (slurm-wlm and munge)";
  }
  const std::string problem = enterOwnNetwork();
  if (!problem.empty()) return problem;
  // Slurm's look-ups give nothing where there are only addresses of 127.0.0.0/8.
  return runsWell("ip addr replace 10.0.0.1/32 dev lo") ? "" : "`ip` cannot add an address";
}

class SlurmCluster {
 public:
  // The nodes see another, empty folder in place of `hidden`.
  explicit SlurmCluster(const std::string& hidden) {
    const std::string key = folder_.path("munge.key");
    runsWell("umask 077; dd if=/dev/urandom bs=1024 count=1 of=" + key);
    start({"munged", "-F", "--force", "--key-file=" + key, "--socket=" + folder_.path("munge.socket"),
           "--pid-file=" + folder_.path("munge.pid"), "--log-file=" + folder_.path("munge.log"),
           "--seed-file=" + folder_.path("munge.seed")});
    comesTrue([&] { return runsWell("munge -n -S " + folder_.path("munge.socket")); }, slurm_patience_s);
    setenv("SLURM_CONF", writeConfiguration().c_str(), 1);
    std::filesystem::create_directories(folder_.path("state"));
    start({"slurmctld", "-D", "-i"});
    for (const std::string node : {"node1", "node2"}) {
      start({"unshare", "--mount", "sh", "-c", "mount -t tmpfs none \"$0\" && exec slurmd -D -N " + node, hidden});
    }
  }
  ~SlurmCluster() {
    runsWell("scancel --user=root");
    comesTrue([] { return runCommand({"squeue", "--noheader"}).output.empty(); });
    for (auto daemon = daemons_.rbegin(); daemon != daemons_.rend(); ++daemon) (*daemon)->end(SIGTERM);
  }
  SlurmCluster(const SlurmCluster&) = delete;
  SlurmCluster& operator=(const SlurmCluster&) = delete;

  bool isReady() const {
    return comesTrue(
        [] {
          return runCommand({"sinfo", "--noheader", "--format=%T %D"}).output.find("idle 2") != std::string::npos;
        },
        slurm_patience_s);
  }
  std::string said() const {
    std::string all;
    for (const auto& daemon : daemons_) all += daemon->said();
    return all;
  }

 private:
  // They end with the test, however it ends.
  void start(std::vector<std::string> command) {
    command.insert(command.begin(), {"setpriv", "--pdeathsig", "KILL", "--"});
    daemons_.push_back(std::make_unique<BackgroundProcess>(command));
  }

  std::string writeConfiguration() const {
    std::array<char, 256> host{};
    gethostname(host.data(), host.size() - 1);
    const std::string name = std::string(host.data()).substr(0, std::string(host.data()).find('.'));
    std::string text =
        "ClusterName=test\nSlurmUser=root\nSlurmdUser=root\nAuthType=auth/munge\nCredType=cred/munge\n"
        "ProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nSelectType=select/cons_tres\nMpiDefault=none\n"
        "JobAcctGatherType=jobacct_gather/none\nSwitchType=switch/none\nReturnToService=2\nSlurmctldPort=6817\n"
        "SlurmdParameters=config_overrides\nPartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP\n";
    text += "SlurmctldHost=" + name + "(127.0.0.1)\n";
    text += "AuthInfo=socket=" + folder_.path("munge.socket") + "\n";
    text += "StateSaveLocation=" + folder_.path("state") + "\nSlurmdSpoolDir=" + folder_.path("spool_%n") + "\n";
    text += "SlurmctldPidFile=" + folder_.path("controller.pid") + "\nSlurmdPidFile=" + folder_.path("%n.pid") + "\n";
    for (const std::string number : {"1", "2"}) {
      text +=
          "NodeName=node" + number + " NodeHostname=" + name + " NodeAddr=127.0.0.1 Port=1700" + number + " CPUs=1\n";
    }
    return folder_.write("slurm.conf", text);
  }

  TemporaryFolder folder_;
  std::vector<std::unique_ptr<BackgroundProcess>> daemons_;
};

}  // namespace edgeslam
