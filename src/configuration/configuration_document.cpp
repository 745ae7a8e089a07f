#include "configuration/configuration_document.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <sstream>
#include <vector>

namespace edgeslam {
namespace {

// Where each document begins; what is in them is left to others.
struct DocumentStarts : YAML::EventHandler {
  std::vector<YAML::Mark> starts;

  void OnDocumentStart(const YAML::Mark& mark) override { starts.push_back(mark); }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}
};

}  // namespace

// YAML::LoadAll would read a text that begins with a comma as empty documents without end.
std::optional<ConfigurationProblem> secondDocument(const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  DocumentStarts documents;
  if (!parser.HandleNextDocument(documents) || !parser.HandleNextDocument(documents)) return std::nullopt;
  const YAML::Mark& first = documents.starts.front();
  const YAML::Mark& second = documents.starts.back();
  if (second.pos == first.pos) return ConfigurationProblem{first.line, "is not YAML: a key is expected here"};
  return ConfigurationProblem{second.line, "a second document; only one is expected"};
}

}  // namespace edgeslam
