"""The version of glrt."""

VERSION = "0.1.0"
