"""The window used by hand: `check_*.py` say what a user does in it, and what must come of it.

The window, and with it imgui and its system libraries, lives in a process of its own
(`__main__.py`), which does one check after the other as tests/view/test_window.py asks for it.
"""
