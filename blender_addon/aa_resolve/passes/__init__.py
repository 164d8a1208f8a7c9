# SPDX-License-Identifier: GPL-3.0-or-later
"""The passes of a shot: one small class each, in the table of ``table.py``."""
