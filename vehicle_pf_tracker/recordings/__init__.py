"""Images and truth in and out of files: rosbag2 MCAP, frame folders, videos."""
