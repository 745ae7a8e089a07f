#include <malloc.h>
#include <sys/prctl.h>

#include <csignal>
#include <opencv2/core/utility.hpp>

#include "app/command_line.h"
#include "service/failure_message.h"

int main(int argc, char** argv) {
  cv::setNumThreads(1);           // the same sums in the same order on any machine
  std::signal(SIGPIPE, SIG_IGN);  // `edgeslam replay ... | head` still writes its files
  // Huge pages would be laid over memory that is taken at the start and filled later: up to 20 MB of nothing.
  prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0);
  // What is large goes back to the system when it is let go. By itself glibc would come to lay it among what is small
  // and stays, where its memory is kept.
  mallopt(M_MMAP_THRESHOLD, 256 * 1024);
  mallopt(M_TRIM_THRESHOLD, 2 * 1024 * 1024);
  edgeslam::tellUncaughtErrors();
  return edgeslam::runCommandLine(argc, argv);
}
