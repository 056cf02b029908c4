#include "fppg/files.h"
