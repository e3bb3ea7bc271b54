"""The report of an evaluation, as one page and as tables."""

from vehicle_pf_tracker.evaluation.report.writing import ReportOptions, write_report

__all__ = ["ReportOptions", "write_report"]
