// OpenGL with its functions declared: libOpenGL exports them, no loader is needed.
#pragma once
#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>
