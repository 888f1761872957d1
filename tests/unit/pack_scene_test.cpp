#include "upload/pack_scene.hpp"
#include <gtest/gtest.h>
