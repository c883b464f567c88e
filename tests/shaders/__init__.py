"""Single GLSL functions against closed forms and float64."""
