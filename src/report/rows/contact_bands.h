// The modes of contacts along a run, as bands of colour under the plots.
#pragma once
#include <string>
#include <vector>

#include "observe/report.h"
#include "result/run_file.h"

namespace anholon {

// mode: 0 open, 1 slips, 2 sticks.
struct ContactSpan {
  double begin = 0, end = 0;
  int mode = 0;
};

struct ContactBand {
  std::string name;
  std::vector<ContactSpan> spans;
};

// True if the run has contacts.
bool has_contacts(const RunTable& table);

// Returns one band for each contact, by its columns NAME.mode, .gap, .normal and .friction; a mode that changes between
// two rows does so at the events of the contact. A contact whose mode changes more often than a page can show has no
// band.
std::vector<ContactBand> contact_bands(const RunTable& table, const std::vector<EventReport>& events);

}  // namespace anholon
