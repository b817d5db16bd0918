// The table of result formats.
#include "result/format.h"

namespace anholon {

extern const ResultFormat hdf5_format, csv_format, json_format, parquet_format;

const std::vector<const ResultFormat*>& result_formats() {
  static const std::vector<const ResultFormat*> all = {&hdf5_format, &csv_format, &json_format, &parquet_format};
  return all;
}

}  // namespace anholon
