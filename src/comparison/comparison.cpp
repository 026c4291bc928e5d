#include "comparison/comparison.h"

namespace carom {

std::string_view name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "pass";
    case Verdict::fail:
      return "fail";
    case Verdict::shown:
      return "shown";
    case Verdict::unsupported:
      return "unsupported";
    case Verdict::error:
      return "error";
  }
  return "?";
}

std::string_view name_of(RunStatus status) {
  switch (status) {
    case RunStatus::ok:
      return "ok";
    case RunStatus::unsupported:
      return "unsupported";
    case RunStatus::crashed:
      return "crashed";
    case RunStatus::timeout:
      return "timeout";
    case RunStatus::invalid:
      return "invalid";
  }
  return "?";
}

std::string_view name_of(Accuracy accuracy) {
  switch (accuracy) {
    case Accuracy::exact:
      return "exact";
    case Accuracy::within_tolerance:
      return "within tolerance";
    case Accuracy::chaos:
      return "chaos";
    case Accuracy::systematic:
      return "systematic";
  }
  return "?";
}

}  // namespace carom
